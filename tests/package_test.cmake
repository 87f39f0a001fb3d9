# Installs the package into the build folder, and builds and runs docs/example against it as a stranger would:
# cmake -DBUILD=... -DSOURCE=... -DCOMPILER=... -DBUILD_TYPE=... -P package_test.cmake
set(prefix ${BUILD}/package_test/prefix)
set(work ${BUILD}/package_test/build)
file(REMOVE_RECURSE ${BUILD}/package_test)
function(run)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE out ERROR_VARIABLE err RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed (${code}): ${ARGV}\n${out}\n${err}")
  endif()
  set(out ${out} PARENT_SCOPE)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${SOURCE}/docs/example -B ${work} -G Ninja -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
    "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_EXE_LINKER_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${work})
run(${work}/example)
message(STATUS "${out}")
# In closed form: the bush begins at 3 - 0.8 m and reflects 0.05 of the power; amplitude is the root of it.
foreach(expected "echo at 2.20 m, amplitude 0.224" "echo at 3.80 m" "echo at 5.90 m" "going to the goal")
  if(NOT out MATCHES "${expected}")
    message(FATAL_ERROR "the example printed\n${out}\nwithout '${expected}'")
  endif()
endforeach()
# The installed program finds what was installed beside it, not the source tree.
run(${CMAKE_COMMAND} -E env --unset=THICKET_DATA ${prefix}/bin/thicket worlds)
if(NOT out MATCHES "foliage_wall/bug2.toml")
  message(FATAL_ERROR "the installed program does not find its worlds:\n${out}")
endif()
