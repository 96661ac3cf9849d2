// mapped_file.cpp  A read-only memory-mapped file.
#include "pack/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/status.hpp"

namespace sinew::pack {
namespace {

Status unreadable(const char* path, const char* reason) noexcept {
  return core::make_status(StatusCode::kUnreadable, "%.150s: cannot be read (%s); check the path", path,
                           reason);
}

// The view of an open descriptor; data null for an empty file.
Status map_descriptor(int descriptor, const char* path, const std::byte** data, size_t* size) noexcept {
  struct stat file {};
  if (::fstat(descriptor, &file) != 0) return unreadable(path, std::strerror(errno));
  if (!S_ISREG(file.st_mode)) return unreadable(path, "not a regular file");
  *size = static_cast<size_t>(file.st_size);
  if (*size == 0) return {};
  void* mapped = ::mmap(nullptr, *size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (mapped == MAP_FAILED) return unreadable(path, std::strerror(errno));
  *data = static_cast<const std::byte*>(mapped);
  return {};
}

}  // namespace

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

Status MappedFile::open(const char* path, MappedFile* out) noexcept {
  if (path == nullptr) return core::make_status(StatusCode::kInvalidArgument, "the path is null");
  // Not blocking: a pipe without a writer must be refused, not waited for.
  const int descriptor = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return unreadable(path, std::strerror(errno));
  MappedFile file;
  Status status = map_descriptor(descriptor, path, &file.data_, &file.size_);
  ::close(descriptor);
  if (status.ok()) *out = std::move(file);
  return status;
}

}  // namespace sinew::pack
