#include "dsl/elaborate.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>
#include <vector>

#include "dsl/elaborate_predicate.h"
#include "dsl/names.h"

namespace tightrope::dsl {
namespace {

class ProgramElaborator {
 public:
  ProgramElaborator(const Declarations& declarations, const BodyTable& bodies, const ElaborateOptions& options,
                    Reporter& reporter)
      : declarations_(declarations), bodies_(bodies), options_(options), reporter_(reporter) {}

  Predicate elaborate_declared(const Module& module, const PredicateDecl& declaration) {
    check_name(declaration.name, declaration.name_span);
    const PredicateRequest request{.name = declaration.name,
                                   .doc = declaration.doc,
                                   .module = &module,
                                   .declaration = &declaration,
                                   .motions = {},
                                   .is_instance = false};
    return elaborate_predicate(request, declarations_, bodies_, options_, reporter_);
  }

  std::optional<Predicate> elaborate_instance(const InstanceDecl& instance) {
    check_name(instance.name, instance.name_span);
    PredicateRequest request;
    request.name = instance.name;
    request.is_instance = true;
    if (!resolve(instance, request)) return std::nullopt;
    if (request.doc.empty()) request.doc = request.declaration->doc;
    const Reporter::Context context(reporter_, "in the instance ", instance.name, "", instance.name_span);
    Predicate result = elaborate_predicate(request, declarations_, bodies_, options_, reporter_);
    result.file = instance.name_span.file;
    return result;
  }

 private:
  void check_name(const std::string& name, SourceSpan span) {
    const std::string_view objection = cpp_objection(name);
    if (objection.empty() && !is_generated_name(name)) return;
    reporter_.error(span, fmt::format("a predicate cannot be called `{}`: it {}", name,
                                      objection.empty() ? "is a name that generated code uses" : objection));
  }

  /// Follows instances of instances down to the predicate; the changes nearest to `instance` win.
  bool resolve(const InstanceDecl& first, PredicateRequest& request) {
    std::vector<const InstanceDecl*> chain = {&first};
    std::unordered_set<const InstanceDecl*> visited = {&first};
    for (;;) {
      const InstanceDecl& instance = *chain.back();
      const auto found = declarations_.predicates.find(instance.predicate);
      if (found == declarations_.predicates.end()) {
        if (!declarations_.incomplete) report_unknown(instance);
        return false;
      }
      if (request.doc.empty()) request.doc = instance.doc;
      if (found->second.predicate != nullptr) {
        request.module = found->second.module;
        request.declaration = found->second.predicate;
        break;
      }
      chain.push_back(found->second.instance);
      if (!visited.insert(found->second.instance).second) {
        reporter_.error(instance.predicate_span,
                        fmt::format("the instance `{}` is an instance of itself", instance.name));
        return false;
      }
    }
    bool sound = true;
    for (const InstanceDecl* instance : chain) sound &= take_changes(*instance, request);
    return sound;
  }

  bool take_changes(const InstanceDecl& instance, PredicateRequest& request) {
    std::unordered_set<std::string_view> changed;
    bool sound = true;
    for (const InstanceDecl::Change& change : instance.changes) {
      std::vector<std::string_view> names;
      for (const ParameterDecl& p : request.declaration->parameters) names.push_back(p.name);
      if (std::find(names.begin(), names.end(), change.parameter) == names.end()) {
        const std::string_view closest = closest_name(change.parameter, names);
        reporter_.error(change.span,
                        fmt::format("`{}` has no parameter `{}`", request.declaration->name, change.parameter),
                        closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
        sound = false;
      } else if (!changed.insert(change.parameter).second) {
        reporter_.error(change.span, fmt::format("the motion of `{}` is given twice", change.parameter));
        sound = false;
      }
      request.motions.try_emplace(change.parameter, change.motion);
    }
    return sound;
  }

  void report_unknown(const InstanceDecl& instance) {
    std::vector<std::string_view> names;
    for (const auto& [name, entry] : declarations_.predicates) names.push_back(name);
    std::sort(names.begin(), names.end());
    const std::string_view closest = reporter_.may_suggest() ? closest_name(instance.predicate, names) : "";
    reporter_.error(instance.predicate_span, fmt::format("unknown predicate `{}`", instance.predicate),
                    closest.empty() ? "" : fmt::format("did you mean `{}`?", closest));
  }

  const Declarations& declarations_;
  const BodyTable& bodies_;
  const ElaborateOptions& options_;
  Reporter& reporter_;
};

}  // namespace

Program elaborate(const SourceMap& sources, std::span<const Module> modules, bool incomplete, Diagnostics& diagnostics,
                  const ElaborateOptions& options) {
  Reporter reporter(sources, diagnostics);
  const Declarations declarations = collect_declarations(modules, incomplete, reporter);
  BodyTable bodies;
  for (const Module& module : modules) bodies.emplace(&module, ComprehensionBodies(module));

  Program program;
  for (const Module& module : modules) program.files.push_back(module.file);
  ProgramElaborator elaborator(declarations, bodies, options, reporter);
  const Module& main = modules.front();
  auto predicate = main.predicates.begin();
  auto instance = main.instances.begin();
  while (predicate != main.predicates.end() || instance != main.instances.end()) {  // merged in order of appearance
    const bool take_predicate =
        instance == main.instances.end() ||
        (predicate != main.predicates.end() && predicate->name_span.begin < instance->name_span.begin);
    if (take_predicate) {
      program.predicates.push_back(elaborator.elaborate_declared(main, *predicate++));
    } else if (auto made = elaborator.elaborate_instance(*instance++)) {
      program.predicates.push_back(std::move(*made));
    }
  }
  return program;
}

}  // namespace tightrope::dsl
