#pragma once
/// Processes that do one command's work together, all with the same arguments, each on its share of the queries.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tightrope::ccd {

/// All but rank() and count() are collective: every process calls them in the same order, with spans of equal size.
class Processes {
 public:
  Processes() = default;
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;
  virtual ~Processes() = default;

  virtual std::size_t rank() const = 0;   ///< 0 .. count() - 1
  virtual std::size_t count() const = 0;  ///< at least 1

  /// Replaces each number by the smallest, or the sum, of those that the processes have in its place.
  virtual void smallest(std::span<std::uint64_t> numbers) = 0;
  virtual void sum(std::span<std::uint64_t> numbers) = 0;
  virtual void sum(std::span<double> numbers) = 0;

  /// The text that process `rank` gave.
  virtual std::string text_of(std::size_t rank, std::string text) = 0;
};

/// The only process there is.
class SingleProcess final : public Processes {
 public:
  std::size_t rank() const override { return 0; }
  std::size_t count() const override { return 1; }
  void smallest(std::span<std::uint64_t>) override {}
  void sum(std::span<std::uint64_t>) override {}
  void sum(std::span<double>) override {}
  std::string text_of(std::size_t, std::string text) override { return text; }
};

}  // namespace tightrope::ccd
