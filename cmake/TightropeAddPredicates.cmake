# tightrope_add_predicates(TARGET FILES a.pred .. [BOUNDS float|safe|tight|static|interval|exact|staged ..] [REALS double|float ..] [SIMD] [CUDA]
#                          [TESTS])
#
# Compiles predicates at build time and lets TARGET include the results, "a.tight.double.h" and so on (BOUNDS default to
# tight, REALS to double). An INTERFACE library as TARGET passes them on to whoever links it in the same build.
#
# SIMD makes the headers for vector classes too, "a.tight.double.simd.h" (not of exact and staged).
#
# CUDA makes batches of calls on a GPU too, "a.tight.double.cuda.h" (not of exact and staged), and adds their kernels,
# "a.tight.double.cu", to TARGET's sources. Needs enable_language(CUDA) and a TARGET that is compiled.
#
# TESTS builds the generated tests too, one executable TARGET_<stem>_generated_tests a file, registered with CTest as
# generated.TARGET.<stem> (label `generated`; needs GoogleTest, and enable_testing() in the top-level CMakeLists.txt).
cmake_policy(PUSH)
cmake_policy(VERSION 3.20)  # functions keep the policies of their definition: depfiles work in projects of any age

function(tightrope_add_predicates target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SIMD;CUDA;TESTS" "" "FILES;BOUNDS;REALS")
  if(NOT TARGET ${target})
    message(FATAL_ERROR "tightrope_add_predicates: ${target} is not a target")
  endif()
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "tightrope_add_predicates: unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_FILES)
    message(FATAL_ERROR "tightrope_add_predicates: FILES is missing")
  endif()
  if(NOT arg_BOUNDS)
    set(arg_BOUNDS tight)
  endif()
  if(NOT arg_REALS)
    set(arg_REALS double)
  endif()
  foreach(bound IN LISTS arg_BOUNDS)
    if(NOT bound MATCHES "^(float|safe|tight|static|interval|exact|staged)$")
      message(FATAL_ERROR
        "tightrope_add_predicates: unknown bound ${bound} (float, safe, tight, static, interval, exact or staged)")
    endif()
  endforeach()
  foreach(real IN LISTS arg_REALS)
    if(NOT real MATCHES "^(double|float)$")
      message(FATAL_ERROR "tightrope_add_predicates: unknown scalar type ${real} (double or float)")
    endif()
  endforeach()
  get_target_property(type ${target} TYPE)
  if(arg_CUDA AND type STREQUAL INTERFACE_LIBRARY)
    message(FATAL_ERROR "tightrope_add_predicates: CUDA needs a target that is compiled, ${target} is an INTERFACE library")
  endif()
  if(arg_CUDA AND NOT CMAKE_CUDA_COMPILER)
    message(FATAL_ERROR "tightrope_add_predicates: CUDA needs the language: enable_language(CUDA)")
  endif()
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/${target}_predicates)
  foreach(file IN LISTS arg_FILES)
    _tightrope_compile_predicate(${target} ${type} ${directory} ${file} "${arg_BOUNDS}" "${arg_REALS}" "${arg_SIMD}"
      "${arg_CUDA}" "${arg_TESTS}")
  endforeach()
  if(type STREQUAL INTERFACE_LIBRARY)
    target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${directory}>)
    target_link_libraries(${target} INTERFACE tightrope::runtime)
  else()
    target_include_directories(${target} PRIVATE ${directory})
    target_link_libraries(${target} PRIVATE tightrope::runtime)
  endif()
  if(arg_CUDA)  # for the C++ sources that include the batches
    target_include_directories(${target} SYSTEM PRIVATE ${CMAKE_CUDA_TOOLKIT_INCLUDE_DIRECTORIES})
  endif()
endfunction()

# One file of the above: a command that compiles it, a target that runs the command before `target` is built, and tests.
function(_tightrope_compile_predicate target type directory file bounds reals simd cuda tests)
  get_filename_component(path ${file} ABSOLUTE BASE_DIR ${CMAKE_CURRENT_SOURCE_DIR})
  get_filename_component(stem ${file} NAME_WLE)
  string(MAKE_C_IDENTIFIER ${stem} id)
  set(headers)
  set(kernels)
  foreach(bound IN LISTS bounds)
    foreach(real IN LISTS reals)
      list(APPEND headers ${directory}/${stem}.${bound}.${real}.h)
      if(simd AND NOT bound MATCHES "^(exact|staged)$")
        list(APPEND headers ${directory}/${stem}.${bound}.${real}.simd.h)
      endif()
      if(cuda AND NOT bound MATCHES "^(exact|staged)$")
        list(APPEND headers ${directory}/${stem}.${bound}.${real}.cuda.h)
        list(APPEND kernels ${directory}/${stem}.${bound}.${real}.cu)
      endif()
    endforeach()
  endforeach()
  set(outputs ${headers} ${kernels})
  set(options --target cpp$<$<BOOL:${simd}>:,simd>$<$<BOOL:${cuda}>:,cuda>)
  if(tests)
    list(APPEND outputs ${directory}/${stem}.test.cpp)
    list(APPEND options --tests)
  endif()
  # Ninja refuses a depfile that names outputs which its command has no longer: other outputs, another depfile.
  string(SHA1 key "${outputs}")
  string(SUBSTRING ${key} 0 8 key)
  set(depfile ${directory}/${stem}.${key}.d)
  list(JOIN bounds "," bounds)
  list(JOIN reals "," reals)
  file(MAKE_DIRECTORY ${directory})
  add_custom_command(
    OUTPUT ${outputs}
    COMMAND tightrope::compiler compile ${path} --bound ${bounds} --real ${reals} ${options}
            --depfile ${depfile} -o ${directory}
    DEPENDS ${path} tightrope::compiler
    DEPFILE ${depfile}
    COMMENT "tightrope compile ${stem}.pred"
    VERBATIM)
  add_custom_target(${target}_${id}_predicates DEPENDS ${outputs})
  add_dependencies(${target} ${target}_${id}_predicates)
  if(kernels)
    target_sources(${target} PRIVATE ${kernels})
  endif()
  if(NOT tests)
    return()
  endif()
  if(NOT TARGET GTest::gtest_main)
    find_package(GTest REQUIRED)
  endif()
  set(executable ${target}_${id}_generated_tests)
  add_executable(${executable} ${directory}/${stem}.test.cpp)
  add_dependencies(${executable} ${target}_${id}_predicates)
  target_include_directories(${executable} PRIVATE ${directory})
  target_link_libraries(${executable} PRIVATE tightrope::runtime GTest::gtest_main)
  target_compile_features(${executable} PRIVATE cxx_std_20)
  if(COMMAND tightrope_warnings)  # in Tightrope's own build: generated code is held to the same warnings
    tightrope_warnings(${executable})
  endif()
  add_test(NAME generated.${target}.${id} COMMAND ${executable})
  set_tests_properties(generated.${target}.${id} PROPERTIES LABELS generated)
endfunction()

cmake_policy(POP)
