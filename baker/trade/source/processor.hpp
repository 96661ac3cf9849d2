// processor.hpp  Whose costs they are.
#pragma once
#include <string>

namespace sinew::baker {

// As the processor line of perf/reports: model, family, model number; "this machine" where the system does
// not tell.
std::string processor_name();

}  // namespace sinew::baker
