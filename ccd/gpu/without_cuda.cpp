/// The public functions of a library that was built without CUDA.

#include <utility>

#include "tightrope/gpu.h"

namespace tightrope::ccd::gpu {
namespace {

constexpr Result nothing{Status::built_without_cuda, "built without CUDA"};

}  // namespace

struct Workspace::State {};

DeviceCount device_count() noexcept { return {0, nothing}; }
std::optional<Device> device(int) noexcept { return std::nullopt; }

Workspace::Workspace(int) noexcept {}
Workspace::Workspace(Workspace&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
Workspace& Workspace::operator=(Workspace&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}
Workspace::~Workspace() = default;
void Workspace::release() noexcept {}
std::size_t Workspace::device_bytes() const noexcept { return 0; }
std::size_t Workspace::pinned_bytes() const noexcept { return 0; }

template <class Real>
Result collides(const Queries<Real>&, unsigned char*, Workspace&, const Options&, Report*) noexcept {
  return nothing;
}
template <class Real>
Result collides_on_device(const Queries<Real>&, unsigned char*, Workspace&, Stream, const Options&, Report*) noexcept {
  return nothing;
}
template Result collides(const Queries<double>&, unsigned char*, Workspace&, const Options&, Report*) noexcept;
template Result collides(const Queries<float>&, unsigned char*, Workspace&, const Options&, Report*) noexcept;
template Result collides_on_device(const Queries<double>&, unsigned char*, Workspace&, Stream, const Options&,
                                   Report*) noexcept;
template Result collides_on_device(const Queries<float>&, unsigned char*, Workspace&, Stream, const Options&,
                                   Report*) noexcept;

}  // namespace tightrope::ccd::gpu
