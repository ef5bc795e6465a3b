# CMake's toolchain file for WebAssembly: clang with the C and C++ libraries that Debian packages for WebAssembly. deploy/wasm.sh installs
# them.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
foreach(language C CXX)
  set(CMAKE_${language}_COMPILER_TARGET wasm32-wasi)
  # SIMD is fixed at 128 bits. Relaxed SIMD is not used: its results differ between machines.
  set(CMAKE_${language}_FLAGS_INIT "-msimd128 -mbulk-memory -mno-relaxed-simd -nostdlibinc")
endforeach()
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
# No folder of this machine's own headers is searched.
set(CMAKE_C_STANDARD_INCLUDE_DIRECTORIES /usr/include/wasm32-wasi)
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES /usr/include/wasm32-wasi/c++/v1 /usr/include/wasm32-wasi)
set(CMAKE_CXX_FLAGS_INIT "${CMAKE_CXX_FLAGS_INIT} -fno-exceptions")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-mexec-model=reactor")
set(CMAKE_EXECUTABLE_SUFFIX .wasm)
set(CMAKE_EXECUTABLE_SUFFIX_CXX .wasm)
