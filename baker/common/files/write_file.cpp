// write_file.cpp  Atomic writing: a new file beside the old one, flushed, then renamed over it.
#include "baker/common/files/write_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/kept_files.hpp"

namespace sinew::baker {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw BadInput(path + ": cannot be written (" + reason + "); check that the folder exists and has room");
}

// What is being written is locked until it has its name or its process ends. So one that can be locked was
// left by a process that was killed. Where a file system has no locks none can be.
bool lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0; }
bool is_locked_by_another() { return errno == EWOULDBLOCK; }

bool is_file_with_a_name(int descriptor) {
  struct stat file {};
  return ::fstat(descriptor, &file) == 0 && S_ISREG(file.st_mode) && file.st_nlink > 0;
}

constexpr const char* kPart = ".part-";
constexpr size_t kPartDigits = 24;

// A name that no other writer has: process ids are the same again in every container.
std::string part_of(const std::string& place) {
  std::random_device random;
  std::string path = place + kPart;
  for (size_t digit = 0; digit < kPartDigits; ++digit) path += "0123456789abcdef"[random() % 16];
  return path;
}

bool is_part_of(const std::string& name, const std::string& place_name) {
  const std::string begin = place_name + kPart;
  return name.size() == begin.size() + kPartDigits && name.starts_with(begin) &&
         name.find_first_not_of("0123456789abcdef", begin.size()) == std::string::npos;
}

// A link is nobody's part.
void remove_part_if_left(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  if (is_file_with_a_name(descriptor) && lock(descriptor)) ::unlink(path.c_str());
  ::close(descriptor);
}

void remove_left_parts(const std::string& place) {
  namespace fs = std::filesystem;
  const fs::path path(place), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (is_part_of(at->path().filename().string(), path.filename().string()))
      remove_part_if_left(at->path().string());
}

// An open file that is removed again unless it was given its name.
class PartFile {
 public:
  explicit PartFile(const std::string& place) {
    constexpr int kTries = 100;
    for (int tried = 0; tried < kTries && descriptor_ < 0; ++tried) {
      path_ = part_of(place);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) return;
      if (descriptor_ >= 0 && is_taken_for_left()) close();
    }
  }
  ~PartFile() {
    if (descriptor_ < 0) return;
    ::unlink(path_.c_str());
    close();
  }
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  int descriptor() const { return descriptor_; }

  // A full disk may show itself only when the data is flushed.
  bool become(const std::string& place) {
    if (::fsync(descriptor_) != 0 || std::rename(path_.c_str(), place.c_str()) != 0) return false;
    close();
    return true;
  }

 private:
  // Before it was locked.
  bool is_taken_for_left() const {
    return lock(descriptor_) ? !is_file_with_a_name(descriptor_) : is_locked_by_another();
  }
  void close() {
    ::close(descriptor_);
    descriptor_ = -1;
  }

  std::string path_;
  int descriptor_ = -1;
};

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
  return true;
}

// A pipe or a device, which cannot be flushed.
bool write_into(const std::string& place, std::span<const std::byte> bytes) {
  const int descriptor = ::open(place.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool written = write_all(descriptor, bytes);
  const int reason = errno;
  if (::close(descriptor) != 0) return false;
  errno = reason;
  return written;
}

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
  if (exists && !S_ISREG(existing.st_mode)) {
    if (!write_into(place, bytes)) refuse(path, std::strerror(errno));
    return;
  }
  remove_left_parts(place);
  PartFile part(place);
  if (part.descriptor() < 0 || !write_all(part.descriptor(), bytes) || !part.become(place))
    refuse(path, std::strerror(errno));
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
  throw BadInput(path + ": cannot be made a folder (" + error.message() + "); give another path");
}

}  // namespace sinew::baker
