#include "query_io/hdf5_handle.h"

namespace tightrope::ccd::hdf5 {

Quiet::Quiet() {
  // Handles close all that was opened. What HDF5 itself leaves open on a damaged file makes its clean-up at exit
  // complain.
  [[maybe_unused]] static const herr_t no_clean_up = H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &function_, &client_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() { H5Eset_auto2(H5E_DEFAULT, function_, client_); }

const char* group_name(Kind kind) {
  switch (kind) {
    case Kind::vertex_face:
      return "vertex-face";
    case Kind::edge_edge:
      return "edge-edge";
  }
  return "";
}

}  // namespace tightrope::ccd::hdf5
