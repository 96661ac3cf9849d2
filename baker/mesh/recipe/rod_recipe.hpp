// rod_recipe.hpp  What an artist states about bones that swing as rods.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace sinew::baker {

class JsonSection;

struct RodRecipe {
  std::string name;  // its root's where none is stated
  std::string root;  // the first bone that swings; it hangs on its parent, which does not
  std::string end;   // the last one, below the root: a chain. Empty: all bones below the root, a tree
  // A strap's: the bone that holds the last one's end as well. Empty: none, unless max_displacement is not
  // stated and the skin leaves no doubt (rod_end.hpp). Frequency and damping ratio are those of the rod with
  // its end free.
  std::string end_joint = {};

  // The file's own spring bones that begin at `root`, with their numbers and colliders: only max_displacement
  // and start count beside it.
  bool as_in_file = false;

  // "start": what a tick's iteration starts from, "learned" or "continued" (sinew::RodWarmStart). The first
  // needs weights of a COPINGNet: sinew-bake character --rods.
  bool learned_start = false;

  double radius_m = 0;  // 0: as thick as the flesh on each bone; else above 0 .. 10
  // 1 .. 1e5. Heavier than 1000 it swings slower, by the square root, and air takes less of its velocity;
  // lighter, the other way round.
  double density_kg_m3 = 1000;
  double young_modulus_pa = 1e6;  // above 0 .. 1e12, against bending
  double torsion_modulus_pa = 0;  // above 0 .. 1e12; not stated: as young_modulus_pa
  // 0.01 .. 100, instead of the moduli: each joint is made as stiff as lets the whole swing at about so many
  // times a second, whatever its length and radius, at a density of 1000. 0: the moduli count.
  double frequency_hz = 0;
  // 0 .. 2, of its slowest swing and instead of damping_s: at 0.25 a swing is a fifth of the one before.
  std::optional<double> damping_ratio = {};
  double damping_s = 0.02;  // 0 .. 10: moment by rate of bending over moment by bending
  double drag_per_s = 0.5;  // 0 .. 1000: share of its velocity that air takes a second, at a density of 1000
  double gravity = 1;       // 0 .. 100, times the earth's
  // 0 .. 1, the share of gravity that bends what the artist posed. 0: the pose is what gravity has made of
  // it, and only turning against gravity is felt. 1: the pose is the shape without gravity.
  double sag = 0;
  // 0.01 .. 2, share of its length that it is shown away from its pose at most, approached smoothly: an angle
  // in radians. 0: no limit. Not beside end_joint.
  double max_displacement = 0;
};

// The list "rods". Throws BadInput as JsonSection does, and where moduli and a frequency are both stated, or
// what holds the end and how far it may go.
std::vector<RodRecipe> read_rod_recipes(JsonSection& section);

}  // namespace sinew::baker
