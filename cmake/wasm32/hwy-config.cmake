# Highway's headers alone: a page has one instruction set, and nothing of the library chooses one. They lie in a folder with headers of
# this machine's own C library, which must not be seen.
find_path(HWY_HEADERS hwy/highway.h PATHS /usr/include /usr/local/include NO_DEFAULT_PATH REQUIRED)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/headers)
file(CREATE_LINK ${HWY_HEADERS}/hwy ${CMAKE_BINARY_DIR}/headers/hwy SYMBOLIC)
add_library(hwy::hwy INTERFACE IMPORTED)
target_include_directories(hwy::hwy INTERFACE ${CMAKE_BINARY_DIR}/headers)
