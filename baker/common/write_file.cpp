// write_file.cpp  Atomic writing: a new file beside the old one, flushed, then renamed over it.
#include "baker/common/write_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/kept_files.hpp"

namespace sinew::baker {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw BadInput(path + ": cannot be written (" + reason + "); check that the folder exists and has room");
}

// An open file that is removed again unless it was kept.
class PartFile {
 public:
  PartFile(std::string path, bool temporary) : path_(std::move(path)), temporary_(temporary) {
    const int exclusive = temporary ? O_EXCL : 0;
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | exclusive | O_CLOEXEC, 0666);
  }
  ~PartFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    if (temporary_) ::unlink(path_.c_str());
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }

  bool write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes = bytes.subspan(static_cast<size_t>(written));
    }
    return true;
  }

  // A full disk may show itself only when the data is flushed or the file closed. A pipe or device cannot be
  // flushed.
  bool finish() {
    if (temporary_ && ::fsync(descriptor_) != 0) return false;
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (::close(descriptor) == 0) return true;
    const int reason = errno;
    if (temporary_) ::unlink(path_.c_str());
    errno = reason;
    return false;
  }

 private:
  std::string path_;
  bool temporary_;
  int descriptor_ = -1;
};

// A link stays a link: what it points to is replaced.
std::string resolve_link(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, error);
  return error ? path : target.string();
}

}  // namespace

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  refuse_over_kept(path);
  const std::string place = resolve_link(path);
  struct stat existing {};
  const bool exists = ::stat(place.c_str(), &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode)) refuse_directory(path);
  // Renaming over a device or a pipe would replace it: those are written to.
  const bool beside = !exists || S_ISREG(existing.st_mode);
  const std::string part_path = beside ? place + ".part-" + std::to_string(::getpid()) : place;

  PartFile part(part_path, beside);
  if (!part.is_open() || !part.write(bytes) || !part.finish()) refuse(path, std::strerror(errno));
  if (!beside) return;
  if (std::rename(part_path.c_str(), place.c_str()) == 0) return;
  const std::string reason = std::strerror(errno);
  ::unlink(part_path.c_str());
  refuse(path, reason);
}

void write_file(const std::string& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void refuse_directory(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw BadInput(path + ": cannot be written (it is a directory); name a file in it");
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (!error) return;
  throw BadInput(path + ": cannot be made a folder (" + error.message() + "); name another place");
}

}  // namespace sinew::baker
