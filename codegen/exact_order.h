#pragma once
/// The order in which exact code computes a stage, which outputs need which node, and how wide its integers are.

#include <cstdint>
#include <functional>
#include <vector>

#include "codegen/exact_program.h"

namespace tightrope::codegen {

/// What of a stage is computed: the signs of its `sign` outputs, or the values of all outputs that have one.
enum class ExactPart { signs, values };

/// The nodes that a stage computes, operands first.
struct ExactOrder {
  std::vector<ExactId> nodes;         ///< without inputs and constants
  std::vector<std::uint64_t> wanted;  ///< by node of the graph: the bits (wanted_bit) of the elements that need it
  std::vector<int> slots;             ///< the input slots that the elements depend on, ascending
  bool raises = false;                ///< a node needs the number 1 as an input
  bool several = false;               ///< not every node is needed by every element
};

ExactOrder exact_order(const dsl::Stage& stage, const ExactProgram& program, std::size_t index, ExactPart part);

/// Calls function(element index in the stage, its output, the element) for every element of the part.
using ExactVisitor = std::function<void(std::size_t, const dsl::Output&, const ExactElement&)>;
void for_each_element(const dsl::Stage& stage, const ExactStage& exact, ExactPart part, const ExactVisitor& visit);

/// The number of output elements of a stage.
std::size_t element_count(const dsl::Stage& stage);

/// The bit of a `wanted` mask that stands for element `element` of `count`: one each up to 64, else shared.
int wanted_bit(std::size_t element, std::size_t count);

/// L of FixedNumbers<L> (runtime/tightrope/exact_sign.h) for inputs of one or two words: the most bits of an input, its
/// sign not counted, with which no value of degree d takes more than d * `words` words, if that leaves enough for
/// ordinary inputs, else as many as those need; 0 where integers of fixed width do not pay.
int fixed_input_bits(const ExactGraph& graph, const ExactOrder& order, int words);

/// Words of the widest integer of FixedNumbers<input_bits>.
int widest_words(const ExactGraph& graph, const ExactOrder& order, int input_bits);

}  // namespace tightrope::codegen
