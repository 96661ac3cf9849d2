# Cross-builds the runtime as WebAssembly with 128-bit SIMD, for browsers, with Debian's clang, C library and C++ library of that target
# (scripts/install_packages.sh web).
set(CMAKE_SYSTEM_NAME WASI)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_C_FLAGS_INIT "-msimd128")
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -stdlib=libc++ -fno-exceptions -D_WASI_EMULATED_MMAN")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(hwy_DIR ${CMAKE_CURRENT_LIST_DIR}/wasm32)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}/wasm32)
