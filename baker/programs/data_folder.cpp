// data_folder.cpp  see data_folder.hpp.
#include "baker/programs/data_folder.hpp"

#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/read_file.hpp"
#include "baker/common/write_file.hpp"

namespace sinew::baker {

void begin_data_folder(const std::string& folder, const std::string& plan_path) {
  const std::string plan = read_text(plan_path);
  const std::string kept = (std::filesystem::path(folder) / "plan.json").string();
  if (std::filesystem::exists(kept)) {
    if (read_text(kept) == plan) return;
    throw BadInput(folder + ": its runs are of another plan than " + plan_path + "; give another folder");
  }
  make_folder(folder);
  write_file(kept, plan);
}

}  // namespace sinew::baker
