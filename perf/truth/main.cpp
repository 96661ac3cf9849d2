// main.cpp  perf_truth: how far the ground truth is from itself: without inertia, at shorter steps and on a
// finer cage.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "baker/common/bad_input.hpp"
#include "baker/common/on_all_cores.hpp"
#include "baker/mesh/graph/tissue_layout.hpp"
#include "baker/mesh/recipe/import_character.hpp"
#include "baker/truth/motion/pick_clips.hpp"
#include "baker/truth/tissue_truth.hpp"

using namespace sinew::baker;

namespace {

constexpr double kRate_hz = 60, kSlower = 16;
constexpr int kManySubsteps = 64, kFiner = 2;

struct Options {
  std::string character, recipe;
  size_t clips = 5;
  double seconds = 1.5;
  bool slow = false;
};

// What a character is simulated from; large, and shared.
struct Body {
  Character character;
  Recipe recipe;
  TissueLayout layout;

  explicit Body(const Options& options)
      : recipe(options.recipe.empty() ? Recipe{} : read_recipe(options.recipe)) {
    character = import_character(options.character, recipe);
    layout = layout_tissue(character, recipe);
    if (layout.regions.empty()) throw BadInput(options.character + ": no part is soft tissue");
  }
  Body with_finer_cage() const {
    Vector3 low = character.positions.front(), high = low;
    for (const Vector3& p : character.positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double cell_m = TissueTruth(character, layout, recipe).cage().cell_m;
    Body finer = *this;
    finer.recipe.voxels_high = static_cast<int>(std::lround(kFiner * (high - low).maxCoeff() / cell_m));
    return finer;
  }
};

// Displacements of the regions' vertices, tick by tick, in the character's axes.
using Roll = std::vector<Vector3>;

struct Run {
  double pace = 1;
  int substeps = 0;  // 0: as usual
  bool gravity = true;
};

Roll roll_out(const Body& body, const Motion& motion, const Options& options, const Run& run) {
  TissueTruth truth(body.character, body.layout, body.recipe);
  const int usual = usual_substeps(truth.modal_bases(body.layout, kMostModes), kRate_hz);
  const auto paced = [&](double t_s) { return motion(run.pace * t_s); };
  if (run.gravity)
    truth.start(paced);
  else
    truth.start(paced, Vector3::Zero());
  Roll roll;
  const long ticks = std::lround(options.seconds / run.pace * kRate_hz);
  for (long tick = 0; tick < ticks; ++tick) {
    const TruthFrame frame = truth.advance(kRate_hz, run.substeps > 0 ? run.substeps : usual);
    const Eigen::Matrix3d axes = frame.pose.root.topLeftCorner<3, 3>();
    for (const Region& region : body.layout.regions)
      for (const int v : region.vertices) {
        const auto at = static_cast<size_t>(v);
        roll.emplace_back(axes.transpose() * (frame.truth[at] - frame.skinned[at]));
      }
  }
  return roll;
}

// Throws std::runtime_error where nothing moves.
double mean_of(const Roll& roll) {
  double sum = 0;
  for (const Vector3& u : roll) sum += u.norm();
  if (!(sum > 0)) throw std::runtime_error("nothing moves");
  return sum / static_cast<double>(roll.size());
}

double share_off(const Roll& roll, const Roll& reference) {
  double off = 0, whole = 0;
  for (size_t i = 0; i < roll.size(); ++i)
    off += (roll[i] - reference[i]).norm(), whole += reference[i].norm();
  if (!(whole > 0)) throw std::runtime_error("nothing moves");
  return off / whole;
}

struct Row {
  std::string motion = {};
  double mean_mm = 0;
  std::optional<double> slow_share = {}, many_substeps = {}, finer_cage = {};
  std::string fault = {};
};

std::string told(const std::optional<double>& share) {
  char text[32] = "";
  if (share) std::snprintf(text, sizeof text, "%.4f", *share);
  return text;
}

struct NamedMotion {
  std::string name;
  Motion motion;
};

Row measure(const Body& body, const NamedMotion& of, const Options& options) {
  Row row{.motion = of.name};
  try {
    if (options.slow) {
      const Roll still = roll_out(body, of.motion, options, {.pace = 1 / kSlower, .gravity = false});
      const Roll moving = roll_out(body, of.motion, options, {.gravity = false});
      row.mean_mm = 1e3 * mean_of(moving);
      row.slow_share = mean_of(still) / mean_of(moving);
    } else {
      const Roll usual = roll_out(body, of.motion, options, {});
      row.mean_mm = 1e3 * mean_of(usual);
      row.many_substeps = share_off(usual, roll_out(body, of.motion, options, {.substeps = kManySubsteps}));
    }
  } catch (const std::runtime_error& fault) {
    row.fault = fault.what();
  }
  return row;
}

// Eight times as many tetrahedra take long: of the liveliest motion alone.
void hold_against_finer_cage(const Body& body, const std::vector<NamedMotion>& motions,
                             const Options& options, std::vector<Row>* rows) {
  const auto liveliest = std::ranges::max_element(*rows, {}, &Row::mean_mm);
  const Motion& motion = motions[static_cast<size_t>(liveliest - rows->begin())].motion;
  try {
    Roll rolls[2];
    on_all_cores("cages", 2, 2, [&](size_t k, std::atomic<size_t>& done) {
      rolls[k] = roll_out(k == 0 ? body : body.with_finer_cage(), motion, options, {});
      ++done;
    });
    liveliest->finer_cage = share_off(rolls[0], rolls[1]);
  } catch (const std::runtime_error& fault) {
    liveliest->fault = std::string("finer cage: ") + fault.what();
  }
}

std::vector<Row> measure_all(const Options& options) {
  const Body body(options);
  std::vector<NamedMotion> motions;
  for (const size_t c : pick_clips(body.character, options.clips)) {
    const Clip& clip = body.character.clips[c];
    motions.push_back({clip.name, clip_motion(body.character, clip)});
  }
  if (motions.empty()) motions.push_back({"shake", shake_motion(body.character)});
  std::vector<Row> rows(motions.size());
  on_all_cores("truth", rows.size(), rows.size(), [&](size_t m, std::atomic<size_t>& done) {
    rows[m] = measure(body, motions[m], options);
    ++done;
  });
  if (!options.slow) hold_against_finer_cage(body, motions, options, &rows);
  return rows;
}

void print(const std::string& name, const std::vector<Row>& rows) {
  for (const Row& row : rows)
    std::printf("\"%s\",\"%s\",%.3f,%s,%s,%s,\"%s\"\n", name.c_str(), row.motion.c_str(), row.mean_mm,
                told(row.slow_share).c_str(), told(row.many_substeps).c_str(), told(row.finer_cage).c_str(),
                row.fault.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Numerical error of a character's ground truth, as fractions of its mean displacement: CSV");
  Options options;
  std::string name;
  app.add_option("character", options.character, "skinned glTF or VRM")->required();
  app.add_option("--name", name, "what the rows call it")->required();
  app.add_option("--recipe", options.recipe, "JSON; see baker/mesh/recipe/recipe.hpp");
  app.add_option("--clips", options.clips, "so many, evenly picked of those in which joints move");
  app.add_option("--seconds", options.seconds, "of each")->check(CLI::Range(0.1, 60.0));
  app.add_flag("--slow", options.slow,
               "16 times slower and without gravity, not at shorter steps and on a finer cage");
  CLI11_PARSE(app, argc, argv);
  try {
    print(name, measure_all(options));
  } catch (const std::exception& fault) {
    std::fprintf(stderr, "perf_truth: %s\n", fault.what());
    return 2;
  }
  return 0;
}
