# tightrope_warnings(TARGET): the project's warnings; errors with TIGHTROPE_WERROR. Value arithmetic is compiled without
# contraction: generated code does not need it (runtime/tightrope/arithmetic.h), hand-written bounds and tests do. nvcc
# hands the host's part of .cu files to the host's compiler, with lines that -Wpedantic does not like.
function(tightrope_warnings target)
  set(cpp -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wswitch-enum
    # g++ 12 sees overlaps in std::string's own code that cannot be (GCC bug 105329).
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
    -ffp-contract=off $<$<BOOL:${TIGHTROPE_WERROR}>:-Werror>)
  set(cuda -Xcompiler=-Wall,-Wextra,-Wconversion,-Wshadow,-ffp-contract=off
    $<$<BOOL:${TIGHTROPE_WERROR}>:-Werror=all-warnings>)
  target_compile_options(${target} PRIVATE
    "$<$<NOT:$<COMPILE_LANGUAGE:CUDA>>:${cpp}>" "$<$<COMPILE_LANGUAGE:CUDA>:${cuda}>")
endfunction()
