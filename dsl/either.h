#pragma once
/// `either(E1, E2, ...)`: one of several algebraically equal expressions, the one of the smallest size at run time.
///
/// The alternatives' graphs are walked together. Where they have the same operation they share it, and its operands
/// are walked on; where they differ, the values themselves are chosen between (Op::select), all by one condition. Thus
///
///     either(cross(a - p, b - a), cross(b - p, b - a))
///
/// selects a - p or b - p, coordinate by coordinate, and multiplies once. A *linear form* (inputs, their sums,
/// differences and constant multiples) is not walked into: a difference of positions has a meaningful magnitude, a
/// position has none. Alternatives whose outermost operations differ are all computed, and selected at the end.
///
/// The *size* of an alternative is what its largest term can be, about:
///
///     linear form           its magnitude; constants: 1, also as factors
///     product               the product of the factors' sizes
///     quotient              the dividend's size
///     sum, max, root, ...   the largest of the operands' sizes; of sums of as many factors, factor by factor:
///                           |u| |v| for u_y v_z - u_z v_y, with |u| the largest coordinate of u
///     several components,   as a sum
///     coefficients
///
/// where operands that the alternatives have in common do not count. So the example compares the largest coordinates
/// of a - p and b - p, at both ends of the motion. The sizes are computed in floating point; of equal ones the first
/// alternative is taken. This is a choice, not a decision: error bounds hold whatever is taken (of overflowed or NaN
/// sizes the later alternative).
///
/// Lemma (whatever is taken is right). The conditions of one `either` are the same at all places, so the values taken
/// are those of one alternative's expression, up to the order of operands of commutative operations. Alternatives of
/// one `either` within another are equal by the same argument.

#include <span>
#include <vector>

#include "dsl/coefficient.h"

namespace tightrope::dsl {

/// One of `alternatives`, which have the same number of coefficients and are equal one by one.
std::vector<Coefficient> either(Lowering& low, std::span<const std::vector<Coefficient>> alternatives);

}  // namespace tightrope::dsl
