// kept_files.cpp  Files compared by std::filesystem::equivalent.
#include "baker/common/files/kept_files.hpp"

#include <filesystem>
#include <vector>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

namespace fs = std::filesystem;

struct Files {
  std::vector<std::string> kept, promised;
};

Files& files() {
  static Files of_this_process;
  return of_this_process;
}

// Devices and pipes keep nothing that could be lost.
bool is_file(const std::string& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// Where a file that is not there yet would be, links that lead nowhere followed.
fs::path place_of(fs::path path) {
  std::error_code error;
  for (int links = 0; links < 40 && fs::is_symlink(path, error); ++links)
    path = path.parent_path() / fs::read_symlink(path, error);
  return fs::weakly_canonical(fs::absolute(path, error), error);
}

bool same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (is_file(a) && is_file(b)) return fs::equivalent(a, b, error);
  if (fs::exists(a, error) || fs::exists(b, error)) return false;
  return place_of(a) == place_of(b);
}

[[noreturn]] void refuse_input(const std::string& output, const std::string& input) {
  const std::string leads = output == input ? output : output + " is " + input + ", which";
  throw BadInput(leads + " is the input; give another name");
}

}  // namespace

void keep_file(const std::string& path) {
  if (!is_file(path)) return;
  for (const std::string& output : files().promised)
    if (same_file(output, path)) refuse_input(output, path);
  for (const std::string& known : files().kept)
    if (known == path) return;
  files().kept.push_back(path);
}

void promise_file(const std::string& path) {
  refuse_over_kept(path);
  for (const std::string& other : files().promised)
    if (same_file(other, path)) throw BadInput(path + ": would be written twice; give two names");
  files().promised.push_back(path);
}

void refuse_over_kept(const std::string& path) {
  if (!is_file(path)) return;
  for (const std::string& input : files().kept)
    if (same_file(path, input)) refuse_input(path, input);
}

}  // namespace sinew::baker
