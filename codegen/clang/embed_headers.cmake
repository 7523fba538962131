# Writes C++ that holds the texts of HEADERS: cmake -DHEADERS=.. -DOUTPUT=.. -P embed_headers.cmake
# Pieces of raw string literals: compilers need not take literals of any length.
set(entries "")
foreach(header IN LISTS HEADERS)
  get_filename_component(name ${header} NAME)
  file(READ ${header} text)
  string(REPLACE "\n\n" "\n)_text_\"\n    R\"_text_(\n" text "${text}")
  string(APPEND entries "    {\"tightrope/${name}\",\n    R\"_text_(${text})_text_\"},\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"codegen/clang/parse.h\"

namespace tightrope::codegen {

const std::vector<EmbeddedHeader>& runtime_headers() {
  static const std::vector<EmbeddedHeader> headers = {
${entries}  };
  return headers;
}

}  // namespace tightrope::codegen
")
