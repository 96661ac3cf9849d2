// rod_recipe.cpp  The list "rods" of a recipe, every key checked.
#include "baker/mesh/recipe/rod_recipe.hpp"

#include "baker/common/files/json_section.hpp"

namespace sinew::baker {
namespace {

constexpr double kLeastModulus_pa = 1e-3, kMostModulus_pa = 1e12;

// That a rod as the file has it does not have.
constexpr const char* kKeysOfOwn[] = {"end",
                                      "end_joint",
                                      "radius_m",
                                      "density_kg_m3",
                                      "frequency_hz",
                                      "young_modulus_pa",
                                      "torsion_modulus_pa",
                                      "damping_ratio",
                                      "damping_s",
                                      "drag_per_s",
                                      "gravity",
                                      "sag"};

bool read_learned_start(JsonSection& section) {
  const std::string start = section.text("start", "continued");
  if (start != "continued" && start != "learned")
    section.complain("start", "is \"" + start + "\"; it must be \"continued\" or \"learned\"");
  return start == "learned";
}

RodRecipe read_rod(JsonSection& section) {
  RodRecipe rod;
  rod.root = section.text("root");
  rod.name = section.text("name", rod.root);
  if (section.has("end")) rod.end = section.text("end");
  if (section.has("end_joint")) rod.end_joint = section.text("end_joint");
  rod.as_in_file = section.flag("as_in_file", false);
  rod.learned_start = read_learned_start(section);
  if (rod.as_in_file) {
    if (section.has("max_displacement"))
      rod.max_displacement = section.number("max_displacement", 0, 0.01, 2);
    for (const char* other : kKeysOfOwn)
      if (section.has(other)) section.complain(other, "says otherwise than as_in_file; take one of them out");
    section.finish();
    return rod;
  }
  if (section.has("radius_m")) rod.radius_m = section.number("radius_m", 0, 1e-5, 10);
  rod.density_kg_m3 = section.number("density_kg_m3", rod.density_kg_m3, 1, 1e5);
  if (section.has("frequency_hz")) {
    rod.frequency_hz = section.number("frequency_hz", 0, 0.01, 100);
    for (const char* modulus : {"young_modulus_pa", "torsion_modulus_pa"})
      if (section.has(modulus)) section.complain(modulus, "says the same as frequency_hz; state one of them");
  }
  rod.young_modulus_pa =
      section.number("young_modulus_pa", rod.young_modulus_pa, kLeastModulus_pa, kMostModulus_pa);
  rod.torsion_modulus_pa =
      section.number("torsion_modulus_pa", rod.young_modulus_pa, kLeastModulus_pa, kMostModulus_pa);
  if (section.has("damping_ratio")) {
    rod.damping_ratio = section.number("damping_ratio", 0, 0, 2);
    if (section.has("damping_s"))
      section.complain("damping_s", "says the same as damping_ratio; state one of them");
  }
  rod.damping_s = section.number("damping_s", rod.damping_s, 0, 10);
  rod.drag_per_s = section.number("drag_per_s", rod.drag_per_s, 0, 1000);
  rod.gravity = section.number("gravity", rod.gravity, 0, 100);
  rod.sag = section.number("sag", rod.sag, 0, 1);
  if (section.has("max_displacement")) {
    rod.max_displacement = section.number("max_displacement", 0, 0.01, 2);
    if (section.has("end_joint"))
      section.complain("max_displacement",
                       "limits the travel of a free end, and end_joint holds it; state one of them");
  }
  section.finish();
  return rod;
}

}  // namespace

std::vector<RodRecipe> read_rod_recipes(JsonSection& section) {
  std::vector<RodRecipe> rods;
  for (JsonSection& rod : section.sections("rods")) {
    rod.text("note", "");
    const bool enabled = rod.flag("enabled", true);
    const RodRecipe read = read_rod(rod);
    if (enabled) rods.push_back(read);
  }
  return rods;
}

}  // namespace sinew::baker
