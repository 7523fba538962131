#include "tests/gpu/ptx_machine.h"

#include <array>
#include <memory>

namespace tightrope::ptx {

/// 32 fibers. `exchange` and `asking` hold what each gave at the last meeting.
class Warp {
 public:
  Warp() {
    for (Fiber& fiber : fibers_) fiber.stack = std::make_unique<unsigned char[]>(stack_bytes);
  }

  void run(Run kernel, unsigned char* parameter, const Thread& first) {
    kernel_ = kernel;
    parameter_ = parameter;
    for (int lane = 0; lane < lanes; ++lane) {
      Fiber& fiber = fibers_[lane];
      fiber.thread = first;
      fiber.thread.tid += static_cast<std::uint32_t>(lane);
      fiber.thread.warp = this;
      fiber.thread.lane = lane;
      fiber.done = false;
      getcontext(&fiber.context);
      fiber.context.uc_stack.ss_sp = fiber.stack.get();
      fiber.context.uc_stack.ss_size = stack_bytes;
      fiber.context.uc_link = &scheduler_;
      makecontext(&fiber.context, reinterpret_cast<void (*)()>(enter), 0);
    }
    for (bool running = true; running;) {
      running = false;
      for (Fiber& fiber : fibers_) {
        if (fiber.done) continue;
        running = true;
        current_ = this;
        fiber_ = &fiber;
        swapcontext(&scheduler_, &fiber.context);
      }
    }
  }

  /// All lanes that still run come here before one goes on.
  void meet(int lane) { swapcontext(&fibers_[lane].context, &scheduler_); }

  std::array<std::uint32_t, lanes> exchange{};

  bool is_done(int lane) const { return fibers_[lane].done; }

 private:
  struct Fiber {
    std::unique_ptr<unsigned char[]> stack;
    ucontext_t context;
    Thread thread;
    bool done = true;
  };
  static constexpr std::size_t stack_bytes = 1U << 20;

  static void enter() {
    Warp& warp = *current_;
    Fiber& fiber = *warp.fiber_;
    warp.kernel_(fiber.thread, warp.parameter_);
    fiber.done = true;
  }

  static inline Warp* current_ = nullptr;
  std::array<Fiber, lanes> fibers_;
  Fiber* fiber_ = nullptr;
  ucontext_t scheduler_;
  Run kernel_ = nullptr;
  unsigned char* parameter_ = nullptr;
};

void Thread::wait() { warp->meet(lane); }
std::uint32_t Thread::ballot(bool mine) {
  warp->exchange[static_cast<std::size_t>(lane)] = mine ? 1 : 0;
  warp->meet(lane);
  std::uint32_t all = 0;
  for (int i = 0; i < lanes; ++i) all |= (warp->is_done(i) ? 0U : warp->exchange[static_cast<std::size_t>(i)]) << i;
  warp->meet(lane);
  return all;
}
std::uint32_t Thread::shuffle(std::uint32_t mine, std::int64_t from) {
  warp->exchange[static_cast<std::size_t>(lane)] = mine;
  warp->meet(lane);
  const std::uint32_t result = warp->exchange[static_cast<std::size_t>(from & (lanes - 1))];
  warp->meet(lane);
  return result;
}

void launch(Run kernel, const void* parameter, std::size_t bytes, std::uint32_t blocks, std::uint32_t threads) {
  static Warp warp;
  std::vector<unsigned char> shared(most_shared), copy(bytes);
  std::memcpy(copy.data(), parameter, bytes);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    std::memset(shared.data(), 0xab, shared.size());
    for (std::uint32_t first = 0; first < threads; first += lanes) {
      warp.run(kernel, copy.data(), {first, threads, block, blocks, shared.data(), nullptr, 0});
    }
  }
}

}  // namespace tightrope::ptx
