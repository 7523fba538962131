#include "ccd/gpu/decide_open.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "ccd/batch/source.h"
#include "ccd/gpu/stages.h"
#include "tightrope/plain.h"

namespace tightrope::ccd::gpu {

bool in_parts(std::size_t count, std::size_t grain, int threads,
              const std::function<void(std::size_t, std::size_t)>& part) noexcept {
  const std::size_t parts = (count + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> memory_left{true};
  const auto work = [&]() noexcept {
    for (std::size_t i = next++; i < parts && memory_left; i = next++) {
      try {
        part(i * grain, std::min(grain, count - i * grain));
      } catch (const std::bad_alloc&) {
        memory_left = false;
      }
    }
  };
  const std::size_t wanted =
      threads > 0 ? static_cast<std::size_t>(threads) : std::max<std::size_t>(1, std::thread::hardware_concurrency());
  std::vector<std::thread> others;
  try {
    for (std::size_t i = 1; i < std::min(wanted, parts); ++i) others.emplace_back(work);
  } catch (const std::system_error&) {  // fewer threads do as well
  } catch (const std::bad_alloc&) {
  }
  work();
  for (std::thread& other : others) other.join();
  return memory_left;
}

bool copy_rows(void* to, std::size_t width, const void* from, std::size_t from_pitch, std::size_t rows,
               int threads) noexcept {
  constexpr std::size_t bytes_a_part = 1U << 20;
  const std::size_t parts_a_row = (width + bytes_a_part - 1) / bytes_a_part;
  const auto copy_part = [&](std::size_t i, std::size_t) {
    const std::size_t row = i / parts_a_row, first = i % parts_a_row * bytes_a_part;
    std::memcpy(static_cast<char*>(to) + row * width + first, static_cast<const char*>(from) + row * from_pitch + first,
                std::min(bytes_a_part, width - first));
  };
  return in_parts(rows * parts_a_row, 1, threads, std::cref(copy_part));
}

template <class Real>
bool decide_open(const Queries<Real>& queries, std::size_t first, std::size_t count, unsigned char* results,
                 Method method, int threads, std::size_t& open) noexcept {
  constexpr std::size_t queries_a_part = 64;
  constexpr unsigned char is_open = static_cast<unsigned char>(Answer::open);
  std::atomic<std::size_t> all{0};
  if (std::memchr(results + first, is_open, count) == nullptr) {
    open = 0;
    return true;
  }
  const auto decide_part = [&](std::size_t part, std::size_t length) {
    std::array<Real, numbers_per_query> copy;
    std::size_t found = 0;
    for (std::size_t i = first + part; i < first + part + length; ++i) {
      if (results[i] != is_open) continue;
      ++found;
      results[i] = ccd::collides(queries.kind, batch::points_of(queries, i, copy), method) ? 1 : 0;
    }
    all += found;
  };
  const bool decided = in_parts(count, queries_a_part, threads, std::cref(decide_part));
  open = all;
  return decided;
}

template bool decide_open(const Queries<double>&, std::size_t, std::size_t, unsigned char*, Method, int,
                          std::size_t&) noexcept;
template bool decide_open(const Queries<float>&, std::size_t, std::size_t, unsigned char*, Method, int,
                          std::size_t&) noexcept;

}  // namespace tightrope::ccd::gpu
