// data_folder.hpp  A folder of simulated runs, of one plan.
#pragma once
#include <string>

namespace sinew::baker {

// Makes it, with a copy of the plan beside the runs, so that a command that was cut goes on. Throws BadInput
// where the folder's runs are of another plan or of none that is kept there, or it cannot be made.
void begin_data_folder(const std::string& folder, const std::string& plan_path);

}  // namespace sinew::baker
