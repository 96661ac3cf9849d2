// data_folder.cpp  see data_folder.hpp.
#include "baker/programs/data_folder.hpp"

#include <algorithm>
#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/read_file.hpp"
#include "baker/common/files/write_file.hpp"

namespace sinew::baker {

void begin_data_folder(const std::string& folder, const std::string& plan_path) {
  namespace fs = std::filesystem;
  const std::string plan = read_text(plan_path), kept = (fs::path(folder) / "plan.json").string();
  make_folder(folder);
  const auto is_run = [](const fs::directory_entry& file) {
    return file.path().extension() == ".safetensors";
  };
  const bool has_runs = std::ranges::any_of(fs::directory_iterator(folder), is_run),
             has_plan = fs::exists(kept);
  if (has_plan && read_text(kept) == plan) return;
  if (has_plan || has_runs)
    throw BadInput(folder + ": its runs are not known to be of " + plan_path + "; give another folder");
  write_file(kept, plan);
}

}  // namespace sinew::baker
