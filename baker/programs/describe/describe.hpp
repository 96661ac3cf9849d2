// describe.hpp  What is inside a file: as JSON for machines, as a table for people.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "baker/common/files/safetensors.hpp"
#include "baker/measure/loaded_pack.hpp"

namespace sinew::baker {

nlohmann::ordered_json describe_pack(const LoadedPack& pack);
// What whoever wrote its recipe would not expect, a line each.
std::vector<std::string> notes_on(const pack::PackView& view);
nlohmann::ordered_json describe_safetensors(const Safetensors& file);

// The table of either description.
std::string format_description(const nlohmann::ordered_json& description);

}  // namespace sinew::baker
