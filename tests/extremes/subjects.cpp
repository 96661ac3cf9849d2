// subjects.cpp  see subjects.hpp.
#include "tests/extremes/subjects.hpp"

#include "tests/scenes/soft_block.hpp"

namespace sinew::extremes {
namespace {

using scenes::ArmMatter;
using scenes::PackBytes;
using scenes::RodMatter;
using scenes::soft_block;

struct Made {
  const char* name;
  PackBytes pack;
  bool one_rest = true;
};

std::vector<Made> make() {
  std::vector<Made> out;
  out.push_back({"block, network", soft_block({.clip = true})});
  out.push_back({"block, modes", soft_block({.regions = 1, .network = false, .clip = true})});
  out.push_back(
      {"block, limp",
       soft_block({.displacement_limit = 3, .network = false, .frequency_share = 0.2, .clip = true})});
  out.push_back(
      {"block, levels", soft_block({.nodes = 40, .coarser_nodes = {20}, .leaves_out = true, .clip = true})});
  out.push_back(
      {"block, rods", soft_block({.network = false, .rods = RodMatter{.bar = true}, .clip = true})});
  out.push_back({"block, rods within limits",
                 soft_block({.network = false,
                             .rods = RodMatter{.young_modulus_pa = 5e4, .max_displacement = 0.3, .bar = true},
                             .clip = true})});
  out.push_back({"block, limp rods",
                 soft_block({.network = false,
                             .rods = RodMatter{.sag = 1, .young_modulus_pa = 1e4, .max_displacement = 0.5},
                             .clip = true}),
                 false});
  out.push_back(
      {"block, sewn rods", soft_block({.network = false, .rods = RodMatter{.sewn = true}, .clip = true})});
  out.push_back({"block, arms", soft_block({.network = false, .arms = ArmMatter{}, .clip = true})});
  return out;
}

}  // namespace

const std::vector<std::unique_ptr<Subject>>& built_subjects() {
  static const std::vector<Made> packs = make();
  static const std::vector<std::unique_ptr<Subject>> subjects = [] {
    std::vector<std::unique_ptr<Subject>> out;
    for (const Made& made : packs) {
      out.push_back(std::make_unique<Subject>(made.name, made.pack.bytes()));
      out.back()->one_rest = made.one_rest;
    }
    return out;
  }();
  return subjects;
}

}  // namespace sinew::extremes
