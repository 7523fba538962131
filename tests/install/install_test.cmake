# Installs this build into a scratch prefix, moves the prefix (nothing in it may remember where it was), and uses it as
# a stranger would: examples as projects of their own, and generated tests of a predicate compiled by hand.
#
#   cmake -DBUILD=.. -DSOURCE=.. -DSCRATCH=.. -DGENERATOR=.. -DCXX=.. -P install_test.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
  list(JOIN ARGV " " command)
  message(STATUS "${command}")
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "exit status ${result}\n${output}")
  endif()
endfunction()

# Configures, builds and tests a project; `least` is the number of tests that it must have, so that none gets lost.
function(build_and_test source build least)
  run(${CMAKE_COMMAND} -S ${source} -B ${build} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release
      -DCMAKE_PREFIX_PATH=${prefix} ${ARGN})
  run(${CMAKE_COMMAND} --build ${build})
  run(${CMAKE_CTEST_COMMAND} --test-dir ${build} --output-on-failure --no-tests=error --output-junit ${build}/tests.xml)
  file(STRINGS ${build}/tests.xml passed REGEX "status=\"run\"")
  list(LENGTH passed count)
  if(count LESS least)
    message(FATAL_ERROR "${source}: ${count} tests ran, expected at least ${least}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/installed)
set(prefix ${SCRATCH}/moved)
file(RENAME ${SCRATCH}/installed ${prefix})

# Fails if one of the files names the repository, or what lies in it: the build, the place of installation. `known` is a
# path that may be named.
function(expect_no_paths known)
  foreach(file IN LISTS ARGN)
    file(READ ${file} text)
    string(REPLACE "${known}" "" text "${text}")
    foreach(path IN ITEMS ${SOURCE}/ ${BUILD}/ ${SCRATCH}/installed)
      string(FIND "${text}" "${path}" found)
      if(NOT found EQUAL -1)
        message(FATAL_ERROR "${file} names ${path}")
      endif()
    endforeach()
  endforeach()
endfunction()

file(GLOB_RECURSE package_files ${prefix}/*.cmake ${prefix}/*.h)
expect_no_paths("nothing" ${package_files})

foreach(example IN ITEMS first_predicate ccd_query cuda_batch batch)
  file(COPY ${SOURCE}/examples/${example} DESTINATION ${SCRATCH}/projects)  # away from the repository
endforeach()
build_and_test(${SCRATCH}/projects/first_predicate ${SCRATCH}/build/first_predicate 2)
build_and_test(${SCRATCH}/projects/ccd_query ${SCRATCH}/build/ccd_query 1)
if(CUDA)
  build_and_test(${SCRATCH}/projects/cuda_batch ${SCRATCH}/build/cuda_batch 1 -DCMAKE_CUDA_COMPILER=${CUDA})
endif()
build_and_test(${SCRATCH}/projects/batch ${SCRATCH}/build/batch 1)

run(${prefix}/bin/tightrope compile ${SCRATCH}/projects/first_predicate/side_of_door.pred --bound all --real double --tests
    -o ${SCRATCH}/by_hand)
expect_no_paths(${prefix}/ ${SCRATCH}/by_hand/CMakeLists.txt)  # it uses the runtime that was installed
build_and_test(${SCRATCH}/by_hand ${SCRATCH}/build/by_hand 1)

# A fit writes, builds and checks code of its own, with the Tightrope beside it.
run(${prefix}/bin/tightrope-ccd generate cloth-obstacle --queries 300 -o ${SCRATCH}/obstacle)
run(${prefix}/bin/tightrope-ccd fit ${SCRATCH}/obstacle --need toi --build -o ${SCRATCH}/fit)
