#include "dsl/elaborate_predicate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <unordered_set>
#include <utility>

#include "dsl/names.h"

namespace tightrope::dsl {

int Parameter::elements() const {
  int count = 1;
  for (const int extent : array) count *= extent;
  return count;
}

namespace {

constexpr std::int64_t max_slots = 65536;    // scalars that a predicate takes
constexpr std::size_t max_output_name = 60;  // characters of a name made from an expression

class PredicateElaborator {
 public:
  PredicateElaborator(const PredicateRequest& request, const Declarations& declarations, const BodyTable& bodies,
                      const ElaborateOptions& options, Reporter& reporter)
      : request_(request),
        module_(*request.module),
        declarations_(declarations),
        reporter_(reporter),
        elaborator_(declarations, bodies, options, reporter) {
    result_.name = request.name;
    result_.doc = request.doc;
    result_.file = request.module->file;
  }

  Predicate run() {
    const PredicateDecl& declaration = *request_.declaration;
    for (const ParameterDecl& p : declaration.parameters) add_parameter(p);
    for (const RangeDecl& r : declaration.ranges) add_range(r);
    elaborate_groups(request_, reporter_, result_);
    elaborate_normalizations(request_, reporter_, result_);
    run_block(declaration.body, -1, "");
    if (!elaborator_.aborted() && !declarations_.incomplete) check_stages();
    if (!elaborator_.aborted()) {
      for (const PropertyDecl& p : declaration.properties) elaborate_property(p, request_, elaborator_, result_);
    }
    result_.graph = std::move(elaborator_.lowering().graph);
    if (!elaborator_.aborted()) check_homogeneity(reporter_, result_);
    return std::move(result_);
  }

 private:
  void add_parameter(const ParameterDecl& declaration);
  bool evaluate_extents(const ParameterDecl& declaration, Parameter& parameter);
  Value add_slots(Parameter& parameter);
  void add_range(const RangeDecl& range);
  void run_block(const std::vector<Statement>& statements, int stage, const std::string& suffix);
  void run_statement(const Statement& s, int stage, const std::string& suffix);
  void run_loop(const Statement& s, int stage, const std::string& suffix);
  void run_stage(const Statement& s);
  void add_output(const Statement& s, int stage, const std::string& suffix);
  bool name_output(const Statement& s, const std::string& stage, const std::string& suffix, Output& output);
  void check_stages();

  SourceSpan span_of(ExprRange range) const { return module_.exprs[static_cast<std::size_t>(range.root())].span; }

  const PredicateRequest& request_;
  const Module& module_;
  const Declarations& declarations_;
  Reporter& reporter_;
  ExpressionElaborator elaborator_;
  Scope scope_;
  Predicate result_;
  std::unordered_set<std::string> output_names_;
  std::unordered_map<std::string_view, SourceSpan> stage_spans_;
  bool has_stages_ = false;
  bool outputs_lost_ = false;  ///< to errors; so that a stage without outputs may be no further mistake
};

void PredicateElaborator::add_parameter(const ParameterDecl& declaration) {
  const std::string_view objection = cpp_objection(declaration.name);
  if (!objection.empty()) {
    reporter_.error(declaration.span,
                    fmt::format("a parameter cannot be called `{}`: it {}", declaration.name, objection));
  }
  Parameter parameter;
  parameter.name = declaration.name;
  parameter.bounded = declaration.bounded;
  const auto changed = request_.motions.find(declaration.name);
  parameter.moving =
      (changed == request_.motions.end() ? declaration.motion : changed->second) == ParameterDecl::Motion::moving;
  switch (declaration.kind) {
    case ParameterDecl::Kind::unspecified:  // the parser has reported it
    case ParameterDecl::Kind::scalar:
      parameter.dimension = 1;
      break;
    case ParameterDecl::Kind::vec2:
      parameter.dimension = 2;
      break;
    case ParameterDecl::Kind::point2:
      parameter.dimension = 2, parameter.point = true;
      break;
    case ParameterDecl::Kind::vec3:
      parameter.dimension = 3;
      break;
    case ParameterDecl::Kind::point:
      parameter.dimension = 3, parameter.point = true;
      break;
  }
  const bool sound = declaration.kind != ParameterDecl::Kind::unspecified && evaluate_extents(declaration, parameter);
  if (!sound) parameter.array.clear();
  Value value = add_slots(parameter);
  scope_.bind(declaration.name, sound ? std::move(value) : Value{});
  result_.parameters.push_back(std::move(parameter));
}

bool PredicateElaborator::evaluate_extents(const ParameterDecl& declaration, Parameter& parameter) {
  std::int64_t slots = static_cast<std::int64_t>(result_.slots.size());
  std::int64_t elements = 1;
  for (const ExprRange& range : declaration.array) {
    if (range.empty()) return false;
    Scope none;
    const auto extent =
        elaborator_.whole_number(elaborator_.evaluate(module_, range, none), span_of(range), "an array's extent");
    if (!extent) return false;
    if (*extent < 1) {
      reporter_.error(span_of(range), fmt::format("an array's extent must be at least 1, not {}", *extent));
      return false;
    }
    elements *= std::min(*extent, max_slots);
    if (slots + elements * parameter.dimension * (parameter.moving ? 2 : 1) > max_slots) {
      reporter_.error(span_of(range), fmt::format("the parameters hold more than {} scalars", max_slots));
      return false;
    }
    parameter.array.push_back(static_cast<int>(*extent));
  }
  return true;
}

/// Numbers the parameter's scalars (see `Parameter`) and returns its value.
Value PredicateElaborator::add_slots(Parameter& parameter) {
  parameter.first_slot = static_cast<int>(result_.slots.size());
  const int index = static_cast<int>(result_.parameters.size());
  Value value{.extents = parameter.array, .elements = {}};
  for (int element = 0; element < parameter.elements(); ++element) {
    Polynomial p{.dimension = parameter.dimension, .degree = parameter.moving ? 1 : 0, .coefficients = {}};
    for (int time = 0; time <= p.degree; ++time) {
      for (int component = 0; component < p.dimension; ++component) {
        const auto slot = static_cast<std::int32_t>(result_.slots.size());
        result_.slots.push_back({.parameter = index, .element = element, .time = time, .component = component});
        p.coefficients.push_back(run_time(elaborator_.lowering().graph.input(slot)));
      }
    }
    value.elements.push_back(std::move(p));
  }
  return value;
}

void PredicateElaborator::add_range(const RangeDecl& range) {
  if (range.limit.empty()) return;
  Scope none;
  const Value value = elaborator_.evaluate(module_, range.limit, none);
  const auto limit = as_number(value);
  double rounded = 0;
  if (!value.poisoned() && (!limit || limit->sign() <= 0)) {
    reporter_.error(span_of(range.limit), "a range's limit must be a positive number known at compile time");
  } else if (limit) {
    // Rounded down: a double is at most the limit if and only if it is at most the largest double up to the limit.
    rounded = limit->round_down();
    if (rounded == 0) reporter_.error(span_of(range.limit), "this range holds no number but 0");
  }
  for (const auto& [name, span] : range.names) {
    const auto found = std::find_if(result_.parameters.begin(), result_.parameters.end(),
                                    [&, &wanted = name](const Parameter& p) { return p.name == wanted; });
    if (found == result_.parameters.end()) {
      std::vector<std::string_view> candidates;
      for (const Parameter& p : result_.parameters) candidates.push_back(p.name);
      const std::string_view closest = closest_name(name, candidates);
      reporter_.error(span, fmt::format("`{}` is no parameter of this predicate", name),
                      closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
    } else if (found->range) {
      reporter_.error(span, fmt::format("`{}` has a range already", name));
    } else if (rounded > 0) {
      found->range = rounded;
    }
  }
}

void PredicateElaborator::run_block(const std::vector<Statement>& statements, int stage, const std::string& suffix) {
  for (const Statement& s : statements) {
    if (elaborator_.aborted()) return;
    run_statement(s, stage, suffix);
  }
}

void PredicateElaborator::run_statement(const Statement& s, int stage, const std::string& suffix) {
  switch (s.kind) {
    case StatementKind::let:
      scope_.bind(s.name, elaborator_.evaluate(module_, s.expr, scope_));
      break;
    case StatementKind::sign:
    case StatementKind::value:
      add_output(s, stage, suffix);
      break;
    case StatementKind::for_loop:
      run_loop(s, stage, suffix);
      break;
    case StatementKind::stage:
      run_stage(s);
      break;
  }
}

void PredicateElaborator::run_loop(const Statement& s, int stage, const std::string& suffix) {
  if (s.first.empty() || s.last.empty()) return;  // a syntax error
  ExpressionElaborator::Level level(elaborator_);
  if (!level.allowed(s.span)) return;
  const Value first = elaborator_.evaluate(module_, s.first, scope_);
  const Value last = elaborator_.evaluate(module_, s.last, scope_);
  const auto range = elaborator_.loop_bounds(first, span_of(s.first), last, span_of(s.last));
  outputs_lost_ |= !range;
  for (std::int64_t i = range ? range->first : 0; range && i < range->second && elaborator_.charge(1, s.span); ++i) {
    const std::size_t mark = scope_.mark();
    scope_.bind(s.name, scalar(number(i)));
    run_block(s.body, stage, suffix + (i < 0 ? fmt::format("_m{}", -i) : fmt::format("_{}", i)));
    scope_.leave(mark);
  }
}

void PredicateElaborator::run_stage(const Statement& s) {
  const std::string_view objection = cpp_objection(s.name);
  if (!objection.empty() || is_generated_name(s.name) || s.name == result_.name) {
    reporter_.error(s.name_span, fmt::format("a stage cannot be called `{}`: it {}", s.name,
                                             !objection.empty()       ? objection
                                             : s.name == result_.name ? "is the predicate's name"
                                                                      : "is a name that generated code uses"));
  }
  const auto [place, inserted] = stage_spans_.try_emplace(s.name, s.name_span);
  if (!inserted && !s.name.empty()) {
    reporter_.error(s.name_span, fmt::format("the stage `{}` is defined twice", s.name),
                    fmt::format("defined before at {}", reporter_.place(place->second)));
  }
  if (!has_stages_ && !result_.stages.empty()) {
    reporter_.error(s.name_span, "a predicate has stages or outputs at its top level, not both",
                    "move the outputs above into a stage");
  }
  has_stages_ = true;
  result_.stages.push_back({s.name, {}});
  const auto stage = static_cast<int>(result_.stages.size()) - 1;
  run_block(s.body, stage, "");  // what it binds stays visible in later stages
  if (result_.stages.back().outputs.empty() && !outputs_lost_ && !declarations_.incomplete && !elaborator_.aborted()) {
    reporter_.error(s.name_span, fmt::format("the stage `{}` has no outputs", s.name),
                    "outputs are given with `sign` and `value`");
  }
}

void PredicateElaborator::add_output(const Statement& s, int stage, const std::string& suffix) {
  if (stage < 0 && has_stages_) {
    reporter_.error(s.span, "a predicate has stages or outputs at its top level, not both", "move this into a stage");
    return;
  }
  if (stage < 0) {
    if (result_.stages.empty()) result_.stages.push_back({"evaluate", {}});
    stage = 0;
  }
  Stage& target = result_.stages[static_cast<std::size_t>(stage)];
  Output output;
  output.sign = s.kind == StatementKind::sign;
  output.span = s.span;
  // Without `as` the statement's name span is that of the expression.
  const SourceSpan whole = s.name.empty() ? s.name_span : span_of(s.expr);
  output.text = s.expr.empty() ? "" : fold_white_space(reporter_.text(whole));
  const Value value = elaborator_.evaluate(module_, s.expr, scope_);
  if (!value.poisoned()) {
    output.extents = value.extents;
    output.degree = value.degree();
    if (output.degree > 0) output.extents.push_back(output.degree + 1);
    if (value.dimension() > 1) output.extents.push_back(value.dimension());
    for (const Polynomial& p : value.elements) {
      for (const Coefficient& c : p.coefficients) output.nodes.push_back(materialise(elaborator_.lowering(), c));
    }
    elaborator_.checked(value, span_of(s.expr));
  }
  if (name_output(s, target.name, suffix, output)) {
    target.outputs.push_back(std::move(output));
  } else {
    outputs_lost_ = true;
  }
}

/// False, with a diagnostic, if there is no good name for the output.
bool PredicateElaborator::name_output(const Statement& s, const std::string& stage, const std::string& suffix,
                                      Output& output) {
  const char* hint = "name the output with `as`";
  std::string name = s.name.empty() ? output_name(output.text) : s.name;
  if (s.name.empty() && (name.empty() || name.size() > max_output_name)) {
    reporter_.error(s.name_span, "this expression is too long to name its output", hint);
    return false;
  }
  const std::string_view objection = cpp_objection(name);
  if (!objection.empty() || name == "Bounded" || name == stage + "_result") {
    reporter_.error(s.name_span,
                    fmt::format("an output cannot be called `{}`: it {}", name,
                                objection.empty() ? "is a name that generated code uses" : objection),
                    s.name.empty() ? hint : "");
    return false;
  }
  name += suffix;
  if (!output_names_.insert(name).second) {
    reporter_.error(s.name_span, fmt::format("two outputs are called `{}`", name), hint);
    return false;
  }
  output.name = std::move(name);
  return true;
}

/// Generated code makes `stage_result`, `stage_in_range` and others of a stage's name.
void PredicateElaborator::check_stages() {
  for (const Stage& s : result_.stages) {
    for (const char* suffix : {"_result", "_in_range", "_signs", "_values", "_values_result", "_finish"}) {
      const auto clash = stage_spans_.find(s.name + suffix);
      if (clash == stage_spans_.end()) continue;
      reporter_.error(clash->second, fmt::format("a stage cannot be called `{}`: generated code uses the name for `{}`",
                                                 clash->first, s.name));
    }
  }
  if (result_.stages.empty() && !outputs_lost_) {
    reporter_.error(request_.declaration->name_span, fmt::format("the predicate `{}` has no outputs", result_.name),
                    "outputs are given with `sign` and `value`");
  }
  const bool clash = std::any_of(result_.stages.begin(), result_.stages.end(),
                                 [&](const Stage& s) { return !has_stages_ && s.name == result_.name; });
  if (clash) {
    reporter_.error(
        request_.declaration->name_span,
        fmt::format("a predicate without stages cannot be called `{}`: its function has that name", result_.name));
  }
}

}  // namespace

Predicate elaborate_predicate(const PredicateRequest& request, const Declarations& declarations,
                              const BodyTable& bodies, const ElaborateOptions& options, Reporter& reporter) {
  return PredicateElaborator(request, declarations, bodies, options, reporter).run();
}

}  // namespace tightrope::dsl
