// commands.hpp  The subcommands of sinew-bake, one file each. A command throws BadInput for unusable input (exit 2) and sets
// *exit_code to 1 when a check failed.
#pragma once
#include <CLI/CLI.hpp>

namespace sinew::baker {

}  // namespace sinew::baker
