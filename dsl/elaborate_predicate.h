#pragma once
/// One predicate or instance: parameters, ranges, statements, outputs, properties.

#include <string>
#include <unordered_map>

#include "dsl/elaborate_expression.h"

namespace tightrope::dsl {

/// What is to be elaborated: a predicate's declaration, and what its instances (outermost last) change.
struct PredicateRequest {
  std::string name;
  std::string doc;
  const Module* module = nullptr;
  const PredicateDecl* declaration = nullptr;
  std::unordered_map<std::string_view, ParameterDecl::Motion> motions;  ///< of changed parameters
  bool is_instance = false;
};

Predicate elaborate_predicate(const PredicateRequest& request, const Declarations& declarations,
                              const BodyTable& bodies, const ElaborateOptions& options, Reporter& reporter);

/// Enters what `group` statements say into `predicate.grouping`, its parameters known.
void elaborate_groups(const PredicateRequest& request, Reporter& reporter, Predicate& predicate);

/// Enters what `normalize` statements say into `predicate.parameters`, ranges known.
void elaborate_normalizations(const PredicateRequest& request, Reporter& reporter, Predicate& predicate);
/// Reports outputs that scaling a group of normalized inputs would change by more than a factor.
void check_homogeneity(Reporter& reporter, const Predicate& predicate);

/// Appends the property, its names resolved, unless it is erroneous. Of an instance, a property of parameters whose
/// motions have come to differ is left out: it does not apply any more.
void elaborate_property(const PropertyDecl& declaration, const PredicateRequest& request,
                        ExpressionElaborator& elaborator, Predicate& predicate);

}  // namespace tightrope::dsl
