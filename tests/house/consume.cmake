# Configures, builds and runs tests/house/consumer. Arguments: HOW (find_package or add_subdirectory), SOURCE,
# BINARY, CONFIG, COMPILER, FLAGS, WRITE_BLOCK: the program that writes a character for it.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${result}:\n${output}")
  endif()
endfunction()

set(work ${BINARY}/consumer_${HOW})
file(REMOVE_RECURSE ${work})
if(HOW STREQUAL "find_package")
  run(${CMAKE_COMMAND} --install ${BINARY} --prefix ${work}/prefix)
  set(arguments -DCMAKE_PREFIX_PATH=${work}/prefix)
else()
  # The core alone: neither adapter, whatever is installed.
  # That it builds, links and steps is looked at, not its speed.
  set(arguments -DSINEW_SOURCE=${SOURCE} -DSINEW_BULLET=OFF -DSINEW_EMBREE=OFF -DCMAKE_CXX_FLAGS_RELEASE=-O0
    -DSINEW_PRECOMPILE=ON -DSINEW_INSTRUCTION_SETS=few)
endif()
run(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${work}/build -G Ninja -DCMAKE_BUILD_TYPE=${CONFIG}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS} ${arguments})
run(${CMAKE_COMMAND} --build ${work}/build)
run(${WRITE_BLOCK} ${work}/block.sinew)
run(${work}/build/consumer ${work}/block.sinew)
file(REMOVE_RECURSE ${work})
