# tightrope_warnings(TARGET): the project's warnings; errors with TIGHTROPE_WERROR. Value arithmetic is compiled without
# contraction: generated code does not need it (runtime/tightrope/arithmetic.h), hand-written bounds and tests do.
function(tightrope_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wswitch-enum
    -ffp-contract=off $<$<BOOL:${TIGHTROPE_WERROR}>:-Werror>)
endfunction()
