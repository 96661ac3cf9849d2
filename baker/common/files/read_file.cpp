// read_file.cpp  Whole files into memory.
#include "baker/common/files/read_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void refuse(const std::string& path, const char* reason) {
  throw BadInput(path + ": cannot be read (" + reason + "); check the path and its permissions");
}

template <class Container>
Container read_whole(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse(path, "it is a directory");
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) refuse(path, std::strerror(errno));

  // Grown by what arrives: a pipe has no size to ask for. What is not filled is cleared in vain.
  Container bytes;
  constexpr size_t kChunk = size_t{1} << 16;
  for (size_t size = 0;;) {
    bytes.resize(size + kChunk);
    const size_t got = std::fread(bytes.data() + size, 1, kChunk, file.get());
    bytes.resize(size += got);
    if (got < kChunk) break;
  }
  if (std::ferror(file.get())) refuse(path, std::strerror(errno));
  return bytes;
}

}  // namespace

std::vector<std::byte> read_file(const std::string& path) { return read_whole<std::vector<std::byte>>(path); }

std::string read_text(const std::string& path) { return read_whole<std::string>(path); }

}  // namespace sinew::baker
