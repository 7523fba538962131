#include "scenes/truth.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "oracle/oracle.h"

namespace tightrope::ccd {

void exact_truths(Kind kind, std::span<const double> points, std::span<unsigned char> truths) {
  constexpr std::size_t batch = 256;  // contacts cost far more than others: small batches balance the threads
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t begin = next.fetch_add(batch); begin < truths.size(); begin = next.fetch_add(batch)) {
      for (std::size_t i = begin; i < std::min(begin + batch, truths.size()); ++i) {
        truths[i] = oracle::contact(kind, points.subspan(24 * i).first<24>()) ? 1 : 0;
      }
    }
  };
  const std::size_t useful = (truths.size() + batch - 1) / batch;
  const std::size_t threads = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), useful);
  std::vector<std::jthread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
  work();
}

}  // namespace tightrope::ccd
