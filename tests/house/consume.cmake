# Configures, builds and runs tests/house/consumer. Arguments: HOW (find_package, pkg_config, either with _shared behind it,
# add_subdirectory, or sub_project, which only configures), SOURCE, BINARY, CONFIG, COMPILER, FLAGS, WRITE_BLOCK: the program
# that writes a character for it.
set(programs consumer caller)  # each is run with the character

# run(command...): what it printed is in `output`.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(configure)
  run(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${work}/build -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER}
    -DCMAKE_CXX_FLAGS=${FLAGS} ${ARGN})
endfunction()

function(build_and_run_programs)
  run(${CMAKE_COMMAND} --build ${work}/build)
  run_programs()
endfunction()

function(run_programs)
  foreach(program IN LISTS programs)
    run(${CMAKE_COMMAND} -E env ${ARGN} ${work}/build/${program} ${work}/block.sinew)
  endforeach()
endfunction()

# compile(program source compiler standard): as without CMake, by what pkg-config answers.
function(compile program source compiler standard)
  separate_arguments(flags UNIX_COMMAND "${FLAGS}")
  run(${compiler} ${standard} ${flags} ${SOURCE}/tests/house/consumer/${source} ${pkg_config_answer} -o ${work}/build/${program})
endfunction()

set(work ${BINARY}/consumer_${HOW})
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})
string(REGEX MATCH "_shared$" shared ${HOW})
if(NOT HOW STREQUAL sub_project)
  run(${WRITE_BLOCK} ${work}/block.sinew)
endif()
# The core alone: neither adapter, whatever is installed.
set(core_alone -DSINEW_SOURCE=${SOURCE} -DSINEW_BULLET=OFF -DSINEW_EMBREE=OFF)
# An installed tree may be moved.
if(HOW MATCHES "find_package|pkg_config")
  run(${CMAKE_COMMAND} --install ${BINARY} --prefix ${work}/before)
  file(RENAME ${work}/before ${work}/prefix)
  file(GLOB_RECURSE shared_libraries ${work}/prefix/libsinew.so*)
  list(GET shared_libraries 0 library)
  cmake_path(GET library PARENT_PATH library_folder)
  if(NOT EXISTS ${work}/prefix/share/doc/sinew/LICENSE)
    message(FATAL_ERROR "LICENSE is not installed")
  endif()
endif()

if(HOW STREQUAL find_package)
  configure(-DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_PREFIX_PATH=${work}/prefix)
  run(${CMAKE_COMMAND} --build ${work}/build)
  file(REMOVE ${shared_libraries})  # nothing of them is asked for
  run_programs()
elseif(HOW STREQUAL find_package_shared)
  # What the shared library links itself is not asked for.
  configure(-DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_PREFIX_PATH=${work}/prefix -DBUILD_SHARED_LIBS=ON -DCMAKE_DISABLE_FIND_PACKAGE_hwy=ON)
  build_and_run_programs()
elseif(HOW MATCHES "^pkg_config")
  set(ENV{PKG_CONFIG_PATH} ${library_folder}/pkgconfig)
  set(ENV{PKG_CONFIG_LIBDIR} ${library_folder}/pkgconfig)  # and nowhere else
  if(shared)
    run(pkg-config --cflags --libs sinew)
  else()
    run(pkg-config --static --cflags --libs sinew)
    # Linkers prefer the shared library, where both are there.
    string(REPLACE " -lsinew " " -l:libsinew.a " output "${output}")
  endif()
  string(STRIP "${output}" output)
  separate_arguments(pkg_config_answer UNIX_COMMAND "${output}")
  file(MAKE_DIRECTORY ${work}/build)
  compile(consumer main.cpp ${COMPILER} -std=c++20)
  compile(caller ../../c/caller.c cc -std=c11)
  if(shared)
    run_programs(LD_LIBRARY_PATH=${library_folder})
  else()
    file(REMOVE ${shared_libraries})
    run_programs()
  endif()
elseif(HOW STREQUAL add_subdirectory)
  # That it builds, links and steps is looked at, not its speed.
  foreach(shared OFF ON)
    configure(${core_alone} -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_FLAGS_RELEASE=-O0 -DSINEW_PRECOMPILE=ON
      -DSINEW_INSTRUCTION_SETS=few -DBUILD_SHARED_LIBS=${shared})
    build_and_run_programs()
  endforeach()
elseif(HOW STREQUAL sub_project)
  # The consumer compares what it has before and after; here it has no build type.
  foreach(shared OFF ON)
    file(REMOVE_RECURSE ${work}/build)
    configure(${core_alone} -DBUILD_SHARED_LIBS=${shared})
    run(${CMAKE_COMMAND} --install ${work}/build --prefix ${work}/prefix)
    file(GLOB installed ${work}/prefix/*)
    if(installed OR EXISTS ${work}/build/compile_commands.json)
      message(FATAL_ERROR "a parent that asked for nothing was left ${installed}, or a compile_commands.json")
    endif()
  endforeach()
endif()
file(REMOVE_RECURSE ${work})
