// fill_once.hpp  Files that several tests begin with and that take seconds to make, kept in the build's
// folder.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "baker/common/files/read_file.hpp"
#include "core/hash.hpp"
#include "tests/baker/common/temporary_folder.hpp"

namespace sinew::test {

// One number of the bytes of all these files. A compiler may have been told a test's own source (__FILE__)
// from the build's folder.
inline std::string fingerprint(const std::vector<std::string>& files) {
  uint64_t key = 0;
  for (const std::string& file : files) {
    const std::string bytes = baker::read_text((std::filesystem::path(SINEW_BINARY_DIR) / file).string());
    key = key * 31 + core::hash64(std::as_bytes(std::span(bytes)));
  }
  return std::to_string(key);
}

// Fills an empty folder: by make(), and from then on, while no file that it is made from changes, with a copy
// of what that wrote. made_from: the programs, their inputs, and the source that says how they are called.
inline void fill_once(const TemporaryFolder& folder, const std::string& name,
                      const std::vector<std::string>& made_from, const std::function<void()>& make) {
  namespace fs = std::filesystem;
  const fs::path shelf = fs::path(SINEW_BINARY_DIR) / "made_for_tests" / name;
  const fs::path kept = shelf / fingerprint(made_from);
  if (fs::exists(kept)) return fs::copy(kept, folder.path(), fs::copy_options::recursive);
  make();
  const fs::path draft = shelf / ("draft" + std::to_string(::getpid()));
  std::error_code another_was_first;
  fs::create_directories(shelf);
  fs::remove_all(draft);  // of a process that was ended
  fs::copy(folder.path(), draft, fs::copy_options::recursive);
  fs::rename(draft, kept, another_was_first);
  if (another_was_first) fs::remove_all(draft);
}

}  // namespace sinew::test
