#include "dsl/declarations.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "dsl/builtins.h"

namespace tightrope::dsl {

ComprehensionBodies::ComprehensionBodies(const Module& module) {
  for (const Expr& expr : module.exprs) {
    if (expr.kind == ExprKind::comprehension) ends_[expr.body_begin].push_back(expr.body_end);
  }
  for (auto& [begin, ends] : ends_) std::sort(ends.rbegin(), ends.rend());
}

ExprId ComprehensionBodies::end(ExprId begin, ExprId before) const {
  const auto found = ends_.find(begin);
  if (found == ends_.end()) return no_expr;
  for (const ExprId end : found->second) {
    if (end < before) return end;
  }
  return no_expr;
}

namespace {

struct Call {
  FunctionEntry* callee = nullptr;
  SourceSpan span;
};

std::string arguments_text(int count) { return fmt::format("{} argument{}", count, count == 1 ? "" : "s"); }

/// Checks the names of one function or predicate. Blocks nest as in the text, but what a stage binds stays visible.
class NameChecker {
 public:
  NameChecker(Declarations& declarations, const Module& module, const ComprehensionBodies& bodies, Reporter& reporter)
      : declarations_(declarations), module_(module), bodies_(bodies), reporter_(reporter) {}

  std::vector<Call> check_function(const FunctionDecl& function) {
    Block block;
    for (const ParameterDecl& p : function.parameters) {
      if (!p.bounded) continue;
      reporter_.error(p.span, fmt::format("the parameter `{}` of a function cannot be `bounded`", p.name),
                      "bounds come in through the parameters of predicates; a function takes any value");
    }
    bind_parameters(function.parameters, block);
    check_statements(function.body, block);
    check_expression(function.result);
    return std::move(calls_);
  }

  void check_predicate(const PredicateDecl& predicate) {
    // Numbers known at compile time: no parameter is visible in them.
    for (const RangeDecl& r : predicate.ranges) check_expression(r.limit);
    for (const PropertyDecl& p : predicate.properties) check_expression(p.number);
    Block block;
    bind_parameters(predicate.parameters, block);
    check_statements(predicate.body, block);
  }

 private:
  using Block = std::unordered_map<std::string_view, SourceSpan>;

  void bind(std::string_view name, SourceSpan span, Block& block, std::string_view what) {
    const auto [place, inserted] = block.try_emplace(name, span);
    if (inserted) {
      ++visible_[name];
    } else {
      reporter_.error(span, fmt::format("{} `{}` is already bound in this block", what, name),
                      fmt::format("bound before at {}", reporter_.place(place->second)));
    }
  }

  void leave(const Block& block) {
    for (const auto& [name, span] : block) {
      if (--visible_[name] == 0) visible_.erase(name);
    }
  }

  void bind_parameters(const std::vector<ParameterDecl>& parameters, Block& block) {
    for (const ParameterDecl& p : parameters) {
      for (const ExprRange& extent : p.array) check_expression(extent);
    }
    for (const ParameterDecl& p : parameters) bind(p.name, p.span, block, "the parameter");
  }

  void check_statements(const std::vector<Statement>& statements, Block& block) {
    for (const Statement& s : statements) {
      switch (s.kind) {
        case StatementKind::let:
          check_expression(s.expr);
          bind(s.name, s.name_span, block, "the name");
          break;
        case StatementKind::sign:
        case StatementKind::value:
          check_expression(s.expr);
          break;
        case StatementKind::for_loop: {
          check_expression(s.first);
          check_expression(s.last);
          Block inner;
          if (!s.name.empty()) bind(s.name, s.name_span, inner, "the loop's variable");
          check_statements(s.body, inner);
          leave(inner);
          break;
        }
        case StatementKind::stage: {
          Block inner;
          check_statements(s.body, inner);
          break;
        }
      }
    }
  }

  void check_expression(ExprRange range) {
    for (ExprId id = range.begin; id < range.end;) {
      if (const ExprId end = bodies_.end(id, range.end); end != no_expr) {
        id = end;
        continue;
      }
      const Expr& expr = module_.exprs[static_cast<std::size_t>(id)];
      if (expr.kind == ExprKind::name) check_name(expr);
      if (expr.kind == ExprKind::call) check_call(expr);
      if (expr.kind == ExprKind::comprehension) {
        Block inner;
        bind(expr.text, expr.span, inner, "the loop's variable");
        check_expression({expr.body_begin, expr.body_end});
        leave(inner);
      }
      ++id;
    }
  }

  /// The name in the tables closest to `name`, or empty; looked for only while the reporter allows.
  template <class... Tables>
  std::string_view closest_of(std::string_view name, const Tables&... tables) {
    if (!reporter_.may_suggest()) return {};
    std::vector<std::string_view> candidates;
    const auto take = [&](const auto& table) {
      for (const auto& entry : table) candidates.push_back(entry.first);
    };
    (take(tables), ...);
    std::sort(candidates.begin(), candidates.end());  // tables are hashed; the answer shall not depend on their order
    return closest_name(name, candidates);
  }

  void check_name(const Expr& expr) {
    if (declarations_.incomplete || visible_.contains(expr.text)) return;
    const std::string_view closest = closest_of(expr.text, visible_);
    std::string hint = closest.empty() ? "" : fmt::format("did you mean `{}`?", closest);
    if (find_builtin(expr.text) != nullptr || declarations_.functions.contains(expr.text)) {
      hint = fmt::format("a function is called with its arguments, `{}(...)`", expr.text);
    }
    reporter_.error(expr.span, fmt::format("unknown name `{}`", expr.text), std::move(hint));
  }

  void check_call(const Expr& expr) {
    const int given = static_cast<int>(expr.operands.size());
    const SourceSpan name_span{expr.span.file, expr.span.begin,
                               expr.span.begin + static_cast<std::uint32_t>(expr.text.size())};
    if (const Builtin* builtin = find_builtin(expr.text)) {
      const bool variadic = builtin->max_arguments < 0;
      if (given >= builtin->min_arguments && (variadic || given <= builtin->max_arguments)) return;
      const std::string wanted =
          variadic ? fmt::format("at least {}", arguments_text(builtin->min_arguments))
          : builtin->min_arguments < builtin->max_arguments
              ? fmt::format("{} or {}", builtin->min_arguments, arguments_text(builtin->max_arguments))
              : arguments_text(builtin->min_arguments);
      reporter_.error(expr.span, fmt::format("`{}` takes {}, not {}", expr.text, wanted, given));
      return;
    }
    const auto found = declarations_.functions.find(expr.text);
    if (found != declarations_.functions.end()) {
      calls_.push_back({&found->second, name_span});
      const int wanted = static_cast<int>(found->second.declaration->parameters.size());
      if (given != wanted) {
        reporter_.error(expr.span, fmt::format("`{}` takes {}, not {}", expr.text, arguments_text(wanted), given));
      }
      return;
    }
    if (declarations_.incomplete) return;
    std::vector<std::pair<std::string_view, int>> of_language;
    for (const Builtin& b : builtins()) of_language.emplace_back(b.name, 0);
    const std::string_view closest = closest_of(expr.text, of_language, declarations_.functions);
    std::string hint = closest.empty() ? "" : fmt::format("did you mean `{}`?", closest);
    if (visible_.contains(expr.text)) hint = "it is the name of a value; an element of an array is written `a[i]`";
    reporter_.error(name_span, fmt::format("unknown function `{}`", expr.text), std::move(hint));
  }

  Declarations& declarations_;
  const Module& module_;
  const ComprehensionBodies& bodies_;
  Reporter& reporter_;
  std::unordered_map<std::string_view, int> visible_;
  std::vector<Call> calls_;
};

using CallGraph = std::unordered_map<FunctionEntry*, std::vector<Call>>;

/// Marks every function that lies on a cycle of calls or reaches one, and reports the call that closes each cycle.
class RecursionFinder {
 public:
  RecursionFinder(const CallGraph& calls, Reporter& reporter) : calls_(calls), reporter_(reporter) {}

  void visit(FunctionEntry* root) {
    if (state_[root] != State::unseen) return;
    push(root);
    while (!path_.empty()) {  // depth first, with a stack of its own: chains of calls may be long
      Frame& frame = path_.back();
      const std::vector<Call>& calls = calls_.at(frame.function);
      if (frame.next == calls.size()) {
        state_[frame.function] = State::done;
        const bool recursive = frame.function->recursive;
        path_.pop_back();
        if (!path_.empty()) path_.back().function->recursive |= recursive;
        continue;
      }
      const Call& call = calls[frame.next++];
      const State state = state_[call.callee];
      if (state == State::unseen) {
        push(call.callee);
      } else if (state == State::open) {
        frame.function->recursive = call.callee->recursive = true;
        reporter_.error(call.span, fmt::format("the function `{}` calls itself", call.callee->declaration->name),
                        "functions are inlined, so they cannot be recursive; `for` loops are unrolled");
      } else {
        frame.function->recursive |= call.callee->recursive;
      }
    }
  }

 private:
  enum class State { unseen, open, done };
  struct Frame {
    FunctionEntry* function = nullptr;
    std::size_t next = 0;
  };

  void push(FunctionEntry* function) {
    state_[function] = State::open;
    path_.push_back({function});
  }

  const CallGraph& calls_;
  Reporter& reporter_;
  std::unordered_map<FunctionEntry*, State> state_;
  std::vector<Frame> path_;
};

class Collector {
 public:
  Collector(Declarations& declarations, Reporter& reporter) : declarations_(declarations), reporter_(reporter) {}

  void collect(const Module& module) {
    for (const FunctionDecl& f : module.functions) {
      if (find_builtin(f.name) != nullptr) {
        reporter_.error(f.name_span, fmt::format("`{}` is a function of the language", f.name), "choose another name");
        continue;
      }
      const auto [place, inserted] = declarations_.functions.try_emplace(f.name, FunctionEntry{&module, &f});
      if (!inserted) defined_twice("function", f.name, f.name_span, place->second.declaration->name_span);
    }
    for (const PredicateDecl& p : module.predicates) add(p.name, p.name_span, {&module, &p, nullptr});
    for (const InstanceDecl& i : module.instances) add(i.name, i.name_span, {&module, nullptr, &i});
  }

 private:
  void add(std::string_view name, SourceSpan span, const PredicateEntry& entry) {
    const auto [place, inserted] = declarations_.predicates.try_emplace(name, entry);
    if (inserted) return;
    const PredicateEntry& first = place->second;
    defined_twice("predicate", name, span,
                  first.predicate != nullptr ? first.predicate->name_span : first.instance->name_span);
  }

  void defined_twice(std::string_view what, std::string_view name, SourceSpan span, SourceSpan first) {
    reporter_.error(span, fmt::format("the {} `{}` is defined twice", what, name),
                    fmt::format("defined before at {}", reporter_.place(first)));
  }

  Declarations& declarations_;
  Reporter& reporter_;
};

}  // namespace

Declarations collect_declarations(std::span<const Module> modules, bool incomplete, Reporter& reporter) {
  Declarations declarations;
  declarations.incomplete = incomplete;
  Collector collector(declarations, reporter);
  // Imports first, so that of two definitions the main file's is the second one.
  for (std::size_t i = modules.size(); i-- > 0;) collector.collect(modules[i]);

  CallGraph calls;
  std::vector<FunctionEntry*> in_order;
  for (const Module& module : modules) {
    const ComprehensionBodies bodies(module);
    for (const FunctionDecl& f : module.functions) {
      std::vector<Call> made = NameChecker(declarations, module, bodies, reporter).check_function(f);
      const auto found = declarations.functions.find(f.name);
      if (found == declarations.functions.end() || found->second.declaration != &f) continue;
      calls[&found->second] = std::move(made);
      in_order.push_back(&found->second);
    }
    for (const PredicateDecl& p : module.predicates) {
      NameChecker(declarations, module, bodies, reporter).check_predicate(p);
    }
  }
  RecursionFinder finder(calls, reporter);
  for (FunctionEntry* function : in_order) finder.visit(function);
  return declarations;
}

}  // namespace tightrope::dsl
