#pragma once
/// Owned HDF5 identifiers, and the layout of query files that reader and writer share.

#include <hdf5.h>

#include <array>
#include <utility>

#include "tightrope/ccd.h"

namespace tightrope::ccd::hdf5 {

/// Closes the identifier with what it was opened with.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Handle() = default;
  Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }

  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

  /// False if closing failed (what was written may then be lost).
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Silences HDF5's own messages, for as long as it lives.
class Quiet {
 public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* client_ = nullptr;
};

inline constexpr std::array<Kind, 2> kinds = {Kind::vertex_face, Kind::edge_edge};  ///< in file order
inline constexpr const char* queries_name = "queries";                              ///< n x 8 x 3 floats
inline constexpr const char* truth_name = "truth";                                  ///< n bytes, 0 or 1

const char* group_name(Kind kind);

}  // namespace tightrope::ccd::hdf5
