// no_preview.cpp  Of a build that cannot draw.
#include "baker/common/bad_input.hpp"
#include "baker/preview/write_preview.hpp"

namespace sinew::baker {

void write_preview(const std::string& path, const pack::PackView&, const std::vector<std::string>&) {
  throw BadInput(path +
                 ": this build draws no pictures; leave --preview out, or build with SINEW_BUILD_SAMPLES");
}

}  // namespace sinew::baker
