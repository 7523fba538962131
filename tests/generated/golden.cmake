# Compares what the command writes with the golden files: cmake -DCOMMAND=.. -DGOLDEN=.. -DOUTPUT=.. -P golden.cmake
# TIGHTROPE_UPDATE_GOLDEN=1 in the environment renews the golden files instead; look at `git diff` before committing.
file(REMOVE_RECURSE ${OUTPUT})
execute_process(COMMAND ${COMMAND} compile ${GOLDEN}/door.pred --bound all --target cpp,cuda -o ${OUTPUT}
  COMMAND_ERROR_IS_FATAL ANY)
set(differs FALSE)
foreach(name IN ITEMS door.float.double.h door.safe.double.h door.tight.double.h door.tight.double.cuda.h
        door.tight.double.cu)
  if(DEFINED ENV{TIGHTROPE_UPDATE_GOLDEN})
    file(COPY ${OUTPUT}/${name} DESTINATION ${GOLDEN})
    continue()
  endif()
  execute_process(COMMAND diff -u ${GOLDEN}/${name} ${OUTPUT}/${name} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    set(differs TRUE)
  endif()
endforeach()
if(differs)
  message(FATAL_ERROR "generated code changed; if it is meant to, run this test with TIGHTROPE_UPDATE_GOLDEN=1")
endif()
