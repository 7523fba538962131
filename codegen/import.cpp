#include "codegen/import.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <set>

#include "codegen/compile.h"
#include "codegen/interface.h"
#include "codegen/simplify.h"
#include "dsl/elaborate.h"
#include "dsl/names.h"
#include "dsl/parser.h"

namespace tightrope::codegen {
namespace {

using dsl::no_node;
using dsl::Node;
using dsl::NodeId;
using dsl::Op;

/// Words of the language that a name may not be (those of functions may).
constexpr std::string_view words[] = {"as",     "at",        "bounded",  "for",    "function",  "group",  "import",
                                      "in",     "instance",  "let",      "moving", "normalize", "of",     "point",
                                      "point2", "predicate", "property", "range",  "return",    "scalar", "sign",
                                      "stage",  "static",    "value",    "vec2",   "vec3"};

/// A compile-time number that is exactly this double: a decimal where a short one is exact, else a multiple of a power
/// of two.
std::string exact_number(double value) {
  if (std::abs(value) < 0x1p53 && value == std::floor(value)) return fmt::format("{:.0f}", value);
  int exponent = 0;
  double mantissa = std::frexp(value, &exponent);
  while (mantissa != std::floor(mantissa)) mantissa *= 2, --exponent;
  if (exponent < 0 && exponent >= -10 && std::abs(value) < 1000) {  // at most 13 significant digits
    std::string digits = fmt::format("{:.10f}", value);
    while (digits.back() == '0') digits.pop_back();
    return digits;
  }
  if (exponent < 0) return fmt::format("{:.0f} / 2^{}", mantissa, -exponent);
  return fmt::format("{:.0f} * 2^{}", mantissa, exponent);
}

class ImportPrinter {
 public:
  /// `kept`: the operations with a constant factor that are rounded where they stand.
  ImportPrinter(const ImportedFunction& function, const std::set<NodeId>& kept) : function_(function), kept_(kept) {
    taken_.insert(std::begin(words), std::end(words));
    count_uses();
    name_parameters();
  }

  std::string print(const std::string& source_name) {
    const std::string predicate = unique(function_.name);
    for (const ImportedOutput& output : function_.outputs) {
      names_of_outputs_[&output] = unique(output.name.empty() ? "returned" : output.name);
    }
    std::string head = fmt::format("predicate {}({}) {{\n", predicate, parameter_list());
    for (NodeId id = 0; id < function_.graph.size(); ++id) {
      if (uses_[static_cast<std::size_t>(id)] > 0 && needs_let(id)) let(id);
    }
    for (std::size_t o = 0; o < function_.outputs.size(); ++o) print_output(function_.outputs[o]);
    const std::string_view real = function_.precision == Precision::binary32 ? " Compile it with --real float." : "";
    return fmt::format("// The C++ function {} of {}, rounding for rounding.{}\n", function_.name,
                       comment_text(source_name), real) +
           head + body_ + "}\n";
  }

 private:
  enum Strength { sum, product, sign, atom };
  struct Text {
    std::string text;
    Strength strength = atom;
    int depth = 0;
  };

  const Node& node(NodeId id) const { return function_.graph[id]; }

  void count_uses() {
    uses_.assign(static_cast<std::size_t>(function_.graph.size()), 0);
    for (const ImportedOutput& output : function_.outputs) {
      for (const NodeId id : output.nodes) ++uses_[static_cast<std::size_t>(id)];
    }
    for (NodeId id = function_.graph.size() - 1; id >= 0; --id) {
      if (uses_[static_cast<std::size_t>(id)] == 0) continue;
      for (const NodeId operand : {node(id).a, node(id).b, node(id).c}) {
        if (operand != no_node) ++uses_[static_cast<std::size_t>(operand)];
      }
    }
  }

  std::string unique(std::string name) {
    std::erase_if(name, [](unsigned char c) { return c > 127 || (std::isalnum(c) == 0 && c != '_'); });
    while (name.starts_with('_')) name.erase(0, 1);
    while (name.find("__") != std::string::npos) name.erase(name.find("__"), 1);
    if (name.empty() || !std::isalpha(static_cast<unsigned char>(name[0]))) name = "x" + name;
    std::string candidate = name;
    for (int n = 2;
         taken_.contains(candidate) || !dsl::cpp_objection(candidate).empty() || dsl::is_generated_name(candidate);
         ++n) {
      candidate = fmt::format("{}_{}", name, n);
    }
    taken_.insert(candidate);
    return candidate;
  }

  /// "t1", "t2", ...
  std::string unique_temporary() {
    for (;;) {
      if (const std::string name = fmt::format("t{}", ++temporaries_); taken_.insert(name).second) return name;
    }
  }

  void name_parameters() {
    for (const ImportedParameter& p : function_.parameters) {
      names_of_parameters_.push_back(unique(p.name));
      int count = 1;
      for (const int extent : p.extents) count *= extent;
      for (int i = 0; i < count; ++i) slots_.push_back(element(names_of_parameters_.back(), p.extents, i));
    }
  }

  static bool is_vector(const std::vector<int>& extents) {
    return !extents.empty() && (extents.back() == 2 || extents.back() == 3);
  }

  static std::string element(const std::string& name, const std::vector<int>& extents, int i) {
    if (!is_vector(extents)) return name + subscripts(extents, i);
    const std::vector<int> outer(extents.begin(), extents.end() - 1);
    constexpr std::string_view components = "xyz";
    return fmt::format("{}{}.{}", name, subscripts(outer, i / extents.back()),
                       components[static_cast<std::size_t>(i % extents.back())]);
  }

  std::string parameter_list() const {
    std::string text;
    std::string last;
    for (std::size_t p = 0; p < function_.parameters.size(); ++p) {
      const std::vector<int>& extents = function_.parameters[p].extents;
      const std::string type = is_vector(extents) ? fmt::format("vec{}", extents.back()) : "scalar";
      const std::vector<int> array(extents.begin(), extents.end() - (is_vector(extents) ? 1 : 0));
      text += text.empty() ? "" : ", ";
      if (type != last) text += type + ' ';
      text += names_of_parameters_[p] + extents_text(array);
      last = type;
    }
    return text;
  }

  bool needs_let(NodeId id) {
    const Op op = node(id).op;
    if (op == Op::input || op == Op::constant) return false;
    constexpr int deepest = 12;
    return function_.names.contains(id) || uses_[static_cast<std::size_t>(id)] > 1 || expression(id).depth > deepest;
  }

  void let(NodeId id) {
    const auto known = function_.names.find(id);
    const std::string text = expression(id).text;
    const std::string name = known != function_.names.end() ? unique(known->second) : unique_temporary();
    add_line(fmt::format("let {} = {}", name, text));
    lets_[id] = name;
  }

  /// A line of at most 100 columns where blanks allow it.
  void add_line(const std::string& text) {
    std::string line = "  ";
    constexpr std::size_t longest = 100;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find(' ', begin), text.size());
      if (line.size() + end - begin > longest && line.find_first_not_of(' ') != std::string::npos) {
        line.pop_back();
        body_ += line + '\n';
        line = "      ";
      }
      line += text.substr(begin, end - begin) + ' ';
      begin = end + 1;
    }
    line.pop_back();
    body_ += line + '\n';
  }

  static std::string within(const Text& text, Strength least) {
    return text.strength < least ? "(" + text.text + ")" : text.text;
  }

  Text operand(NodeId id) {
    if (const auto name = lets_.find(id); name != lets_.end()) return {name->second, atom, 0};
    return expression(id);
  }

  Text expression(NodeId id) {
    const Node& n = node(id);
    NodeId a = n.a;
    NodeId b = n.b;
    if (const auto order = function_.written_order.find(id); order != function_.written_order.end()) {
      if (n.op != Op::fma) std::tie(a, b) = order->second;
    }
    if (n.op == Op::input) return {slots_[static_cast<std::size_t>(n.index)], atom, 0};
    if (n.op == Op::constant) {
      const std::string text = exact_number(n.value);
      const bool quotient = text.find(' ') != std::string::npos;
      return {text, quotient ? product : text[0] == '-' ? sign : atom, 0};
    }
    const Text x = operand(a);
    const Text y = b == no_node ? Text{} : operand(b);
    Text result{"", atom, 1 + std::max(x.depth, y.depth)};
    const auto infix = [&](std::string_view symbol, Strength strength) {
      const auto right = static_cast<Strength>(strength + 1);
      result.text = fmt::format("{} {} {}", within(x, strength), symbol, within(y, right));
      result.strength = strength;
    };
    const auto call = [&](std::string_view name) {
      result.text = fmt::format("{}({}{}{}", name, x.text, b == no_node ? "" : ", ", y.text);
      if (n.op == Op::fma) result.text += ", " + operand(n.c).text;
      result.text += ')';
    };
    switch (n.op) {
      case Op::add:
        infix("+", sum);
        break;
      case Op::sub:
        infix("-", sum);
        break;
      case Op::mul:
        infix("*", product);
        break;
      case Op::div:
        infix("/", product);
        break;
      case Op::neg:
        result.text = "-" + within(x, atom);
        result.strength = sign;
        break;
      case Op::sqrt:
      case Op::abs:
      case Op::min:
      case Op::max:
      case Op::fma:
        call(dsl::op_name(n.op));
        break;
      case Op::input:
      case Op::constant:
      case Op::mul_pow2:
      case Op::certain_nonzero:
      case Op::certain_nonnegative:
      case Op::normalizer:
      case Op::max_magnitude:
      case Op::select:
        assert(false && "imported functions do not have it");
        break;
    }
    if (kept_.contains(id)) result = {fmt::format("rounded({})", result.text), atom, result.depth};
    return result;
  }

  /// What the function returns is named after the variable that held it; elements that were not set leave gaps, and
  /// then every element is an output of its own.
  void print_output(const ImportedOutput& output) {
    const bool whole = output.cells.back() + 1 == static_cast<int>(output.cells.size());
    const std::string base = names_of_outputs_.at(&output);
    if (!output.array) {
      const Text text = operand(output.nodes.front());
      const auto known = function_.names.find(output.nodes.front());
      const bool named = output.name.empty() && known != function_.names.end() && known->second == text.text;
      return add_line(named ? "sign " + text.text : fmt::format("sign {} as {}", text.text, base));
    }
    std::string list;
    for (std::size_t i = 0; i < output.nodes.size(); ++i) {
      const std::string text = operand(output.nodes[i]).text;
      if (!whole) add_line(fmt::format("sign {} as {}", text, unique(fmt::format("{}_{}", base, output.cells[i]))));
      list += (i > 0 ? ", " : "") + text;
    }
    if (whole) add_line(fmt::format("sign [{}] as {}", list, base));
  }

  const ImportedFunction& function_;
  const std::set<NodeId>& kept_;
  std::vector<int> uses_;
  std::set<std::string, std::less<>> taken_;
  std::vector<std::string> names_of_parameters_;
  std::vector<std::string> slots_;
  std::map<NodeId, std::string> lets_;
  std::map<const ImportedOutput*, std::string> names_of_outputs_;
  int temporaries_ = 0;
  std::string body_;
};

/// Nodes with a constant factor that costs a rounding or may cost one in another place.
std::set<NodeId> scalings(const dsl::Graph& graph) {
  std::set<NodeId> result;
  for (NodeId id = 0; id < graph.size(); ++id) {
    const Node& n = graph[id];
    const auto constant = [&](NodeId x) { return graph[x].op == Op::constant; };
    if ((n.op == Op::mul && (constant(n.a) || constant(n.b))) ||
        (n.op == Op::div && (constant(n.a) || constant(n.b)))) {
      result.insert(id);
    }
  }
  return result;
}

}  // namespace

bool computes(const std::string& text, const ImportedFunction& function, std::string& errors) {
  dsl::SourceMap sources;
  dsl::Diagnostics diagnostics;
  const std::uint32_t file = sources.add("imported.pred", text);
  const std::vector<dsl::Module> modules = {dsl::parse(sources, file, diagnostics)};
  const dsl::Program program = dsl::elaborate(sources, modules, diagnostics.has_errors(), diagnostics, {});
  if (diagnostics.has_errors()) {
    errors = diagnostics.render(sources);
    return false;
  }
  // Both graphs in one, so that `simplify` brings both to one form.
  dsl::Predicate merged = program.predicates.front();
  std::vector<NodeId> image;
  for (NodeId id = 0; id < function.graph.size(); ++id) {
    Node n = function.graph[id];
    for (NodeId* operand : {&n.a, &n.b, &n.c}) {
      if (*operand != no_node) *operand = image[static_cast<std::size_t>(*operand)];
    }
    image.push_back(merged.graph.intern(n));
  }
  dsl::Stage imported = merged.stages.front();
  if (imported.outputs.empty()) return false;
  dsl::Output& all = imported.outputs.front();
  all.nodes.clear();
  for (const ImportedOutput& output : function.outputs) {
    for (const NodeId id : output.nodes) all.nodes.push_back(image[static_cast<std::size_t>(id)]);
  }
  imported.outputs.resize(1);
  merged.stages.push_back(imported);
  const dsl::Predicate simple = simplify(merged);
  std::vector<NodeId> compiled;
  for (const dsl::Output& output : simple.stages.front().outputs) {
    compiled.insert(compiled.end(), output.nodes.begin(), output.nodes.end());
  }
  return compiled == simple.stages.back().outputs.front().nodes;
}

std::string import_text(const ImportedFunction& function, const std::string& source_name) {
  const auto text = [&](const std::set<NodeId>& kept) { return ImportPrinter(function, kept).print(source_name); };
  std::string errors;
  if (std::string plain = text({}); computes(plain, function, errors)) return plain;
  std::set<NodeId> kept = scalings(function.graph);
  std::string result = text(kept);
  errors.clear();
  if (!computes(result, function, errors)) {
    if (!errors.empty()) throw InexpressibleFunction(errors);
    throw TranslationError(result);
  }
  constexpr std::size_t most_tries = 200;
  if (kept.size() > most_tries) return result;
  for (const NodeId id : std::set<NodeId>(kept)) {  // those that make no difference go
    kept.erase(id);
    std::string without = text(kept);
    if (computes(without, function, errors)) {
      result = std::move(without);
    } else {
      kept.insert(id);
    }
  }
  return result;
}

}  // namespace tightrope::codegen
