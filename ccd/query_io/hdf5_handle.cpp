#include "query_io/hdf5_handle.h"

namespace tightrope::ccd::hdf5 {

Quiet::Quiet() {
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
