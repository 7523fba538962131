# Generated code compiles without warnings at every level of optimisation, and no product is contracted into a fused
# multiply-add even where the compiler is asked to:
#   cmake -DCOMPILER=.. -DSOURCES=.. -DHEADERS=.. -DRUNTIME=.. -DOUTPUT=.. -P contraction.cmake
set(warnings -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wunused -Werror)
set(fusing -mfma -ffp-contract=fast)

# COUNT becomes the number of fused multiply-adds in the assembly of SOURCE.
function(count_fused source level count)
  get_filename_component(stem ${source} NAME_WLE)
  set(assembly ${OUTPUT}/${stem}${level}.s)
  execute_process(
    COMMAND ${COMPILER} -std=c++20 ${level} ${warnings} ${fusing} -I${RUNTIME} -I${HEADERS} -S ${source} -o ${assembly}
    RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${source} does not compile without warnings at ${level}")
  endif()
  file(STRINGS ${assembly} found REGEX "vfn?m(add|sub)")
  list(LENGTH found number)
  set(${count} ${number} PARENT_SCOPE)
endfunction()

file(MAKE_DIRECTORY ${OUTPUT})
foreach(level IN ITEMS -O0 -O1 -O2 -O3)
  count_fused(${SOURCES}/contraction.cpp ${level} generated)
  if(NOT generated EQUAL 0)
    message(FATAL_ERROR "${generated} fused multiply-adds in generated code at ${level}")
  endif()
  count_fused(${SOURCES}/contraction_control.cpp ${level} control)
  if(control EQUAL 0 AND level MATCHES "-O[23]")
    message(FATAL_ERROR "the control has no fused multiply-add at ${level}: this check could not fail")
  endif()
endforeach()
