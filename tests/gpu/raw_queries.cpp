/// raw_queries QUERIES.. -o STEM: writes the queries of the files as bare doubles in the machine's order, 24 a query,
/// to STEM.vertex-face.raw and STEM.edge-edge.raw: what a machine reads that has no HDF5.

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "query_io/query_files.h"

int main(int argc, char** argv) {
  namespace ccd = tightrope::ccd;
  if (argc < 4 || std::string(argv[argc - 2]) != "-o") {
    std::fprintf(stderr, "usage: raw_queries QUERIES.. -o STEM\n");
    return 2;
  }
  const std::vector<std::string> paths(argv + 1, argv + argc - 2);
  const std::string stem = argv[argc - 1];
  const auto fail = [](const ccd::FileError& error) {
    std::fprintf(stderr, "raw_queries: %s\n", error.message.c_str());
    return 1;
  };
  auto found = ccd::find_query_files(paths, std::nullopt);
  if (const auto* error = std::get_if<ccd::FileError>(&found)) return fail(*error);
  ccd::QueryStream stream(std::get<std::vector<ccd::QueryFile>>(std::move(found)));
  std::ofstream files[2];
  for (const ccd::Kind kind : {ccd::Kind::vertex_face, ccd::Kind::edge_edge}) {
    files[static_cast<int>(kind)].open(stem + "." + std::string(ccd::name(kind)) + ".raw", std::ios::binary);
  }
  constexpr std::size_t limit = 4096;
  ccd::QueryBlock block;
  for (;;) {
    if (const auto error = stream.next(limit, block)) return fail(*error);
    if (block.size() == 0) break;
    files[static_cast<int>(block.kind)].write(reinterpret_cast<const char*>(block.points.data()),
                                              static_cast<std::streamsize>(block.points.size() * sizeof(double)));
  }
  for (std::ofstream& file : files) {
    file.close();
    if (!file) {
      std::fprintf(stderr, "raw_queries: cannot write %s.*.raw\n", stem.c_str());
      return 1;
    }
  }
}
