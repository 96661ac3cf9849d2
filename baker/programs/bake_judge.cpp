// bake_judge.cpp  sinew-bake judge: characters against ground truth, in closed loop as the runtime ticks
// them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/command_line/input_files.hpp"
#include "baker/common/files/safetensors.hpp"
#include "baker/common/progress.hpp"
#include "baker/measure/closed_loop.hpp"
#include "baker/programs/commands.hpp"

namespace sinew::baker {
namespace {

constexpr double kMillimetres = 1e3;

struct JudgeOptions {
  std::vector<std::string> characters, truth;
  std::vector<size_t> ticks = {10, 50, 200, 600};
  std::string trace;
  std::optional<double> most_added;
  std::string isa;
  bool json = false;
};

// ---- what is added up ----

// A node's displacement at two ticks.
struct Moved {
  const float *now, *before;
};

// Distances of one character's nodes, over ticks 1 .. `ticks` of every motion that lasts so long; apart: from
// the first character's; change: of what happens from tick to tick.
struct Sums {
  double nodes = 0, error = 0, skinning = 0, apart = 0, change = 0, skinning_change = 0;
  std::vector<float> errors;

  void add(const Moved& u, const Moved& truth, const float* first) {
    const double distance = length_of(u.now, truth.now);
    nodes += 1;
    error += distance;
    errors.push_back(static_cast<float>(distance));
    skinning += length_of(kNowhere, truth.now);
    apart += length_of(u.now, first);
    float own[3], true_change[3];
    for (int k = 0; k < 3; ++k) {
      own[k] = u.now[k] - u.before[k];
      true_change[k] = truth.now[k] - truth.before[k];
    }
    change += length_of(own, true_change);
    skinning_change += length_of(kNowhere, true_change);
  }
  double mean_mm() const { return kMillimetres * error / nodes; }
  double ratio() const { return error / skinning; }
  double velocity_ratio() const { return skinning_change > 0 ? change / skinning_change : 0; }
  // Of 20 node errors one is larger.
  double p95_mm() const {
    std::vector<float> sorted = errors;
    const auto at = sorted.begin() + static_cast<long>(0.95 * static_cast<double>(sorted.size() - 1));
    std::ranges::nth_element(sorted, at);
    return kMillimetres * static_cast<double>(*at);
  }

 private:
  static constexpr float kNowhere[3] = {};
  static double length_of(const float* a, const float* b) {
    return std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]});
  }
};

struct Judged {
  std::string path;
  std::vector<Sums> sums;    // one for each of the options' ticks
  std::vector<float> trace;  // displacement [ticks + 1][nodes][3] along the last motion
  uint32_t held = 0, fallbacks = 0;
};

// The tick that the trace ends with.
void add_tick(const JudgeOptions& options, size_t tick, const TrueMotion& motion, const float* first,
              size_t nodes, Judged* to) {
  const float *u = &to->trace[3 * nodes * tick], *before = u - 3 * nodes;
  const float *truth = motion.displacement(tick), *truth_before = motion.displacement(tick - 1);
  for (size_t k = 0; k < options.ticks.size(); ++k) {
    if (tick > options.ticks[k] || options.ticks[k] > motion.ticks()) continue;
    for (size_t n = 0; n < 3 * nodes; n += 3)
      to->sums[k].add({u + n, before + n}, {truth + n, truth_before + n}, first + n);
  }
}

TrueMotion read_motion(const std::string& path, const std::vector<LoadedPack>& characters) {
  const Safetensors file = read_safetensors(path);
  for (const LoadedPack& character : characters) check_trajectory_of(file, character.view());
  return {file, characters.front().view()};
}

// All characters along one motion, side by side.
void follow(const JudgeOptions& options, const std::vector<LoadedPack>& characters, const std::string& truth,
            std::vector<Judged>* judged) {
  const TrueMotion motion = read_motion(truth, characters);
  const size_t nodes = characters.front().view().nodes.size();
  for (Judged& one : *judged) one.trace.assign(3 * nodes, 0.0f);  // at rest on the skinning
  std::vector<std::unique_ptr<ClosedLoop>> loops;
  for (const LoadedPack& character : characters)
    loops.push_back(std::make_unique<ClosedLoop>(character, motion));
  const size_t last = std::min(motion.ticks(), std::ranges::max(options.ticks));
  Progress progress("judging " + truth, last);
  for (size_t tick = 1; tick <= last; ++tick) {
    for (size_t c = 0; c < loops.size(); ++c) {
      loops[c]->tick();
      const float* u = loops[c]->displacement();
      (*judged)[c].trace.insert((*judged)[c].trace.end(), u, u + 3 * nodes);
      add_tick(options, tick, motion, loops[0]->displacement(), nodes, &(*judged)[c]);
    }
    progress.update(tick);
  }
  for (size_t c = 0; c < loops.size(); ++c) {
    (*judged)[c].held += loops[c]->held();
    (*judged)[c].fallbacks += loops[c]->fallbacks();
  }
}

// ---- what is told ----

double added_share(const Sums& of, const Sums& first) { return of.error / first.error - 1; }

void print_table(const JudgeOptions& options, const std::vector<Judged>& judged) {
  std::printf("%zu motions; errors are means over control nodes and ticks\n", options.truth.size());
  std::printf("%6s %10s %12s %9s %9s  %s\n", "ticks", "error mm", "of skinning", "added", "apart",
              "character");
  for (const Judged& one : judged) {
    for (size_t k = 0; k < options.ticks.size(); ++k) {
      const Sums &sums = one.sums[k], &first = judged.front().sums[k];
      if (sums.nodes == 0) continue;
      std::printf("%6zu %10.4f %12.4f %+8.2f%% %8.2f%%  %s\n", options.ticks[k], sums.mean_mm(), sums.ratio(),
                  100 * added_share(sums, first), 100 * sums.apart / first.error, one.path.c_str());
    }
    if (one.held + one.fallbacks > 0)
      std::printf("guards: %u nodes held, %u times given up  %s\n", one.held, one.fallbacks,
                  one.path.c_str());
  }
}

nlohmann::ordered_json described(const JudgeOptions& options, const std::vector<Judged>& judged, bool ok) {
  nlohmann::ordered_json out = {
      {"motions", options.truth}, {"characters", nlohmann::json::array()}, {"ok", ok}};
  for (const Judged& one : judged) {
    nlohmann::ordered_json character = {
        {"character", one.path}, {"nodes_held", one.held}, {"fallbacks", one.fallbacks}};
    for (size_t k = 0; k < options.ticks.size(); ++k) {
      const Sums &sums = one.sums[k], &first = judged.front().sums[k];
      if (sums.nodes == 0) continue;
      character["ticks"][std::to_string(options.ticks[k])] = {{"mean_mm", sums.mean_mm()},
                                                              {"p95_mm", sums.p95_mm()},
                                                              {"ratio", sums.ratio()},
                                                              {"velocity_ratio", sums.velocity_ratio()},
                                                              {"added", added_share(sums, first)},
                                                              {"apart", sums.apart / first.error}};
    }
    out["characters"].push_back(character);
  }
  return out;
}

// By compare, so that what is not finite is never within.
bool within(const JudgeOptions& options, const std::vector<Judged>& judged) {
  for (const Judged& one : judged) {
    for (size_t k = 0; k < options.ticks.size() && options.most_added; ++k) {
      const Sums& first = judged.front().sums[k];
      if (first.nodes > 0 && !(added_share(one.sums[k], first) <= *options.most_added)) return false;
    }
  }
  return true;
}

void check_options(const JudgeOptions& options) {
  if (std::ranges::any_of(options.ticks, [](size_t t) { return t < 1 || t > 1'000'000; }))
    throw BadInput("--ticks: must be whole numbers from 1 to 1000000");
  if (!(options.most_added.value_or(0) >= 0)) throw BadInput("--most-added: must be a number from 0 up");
  if (!options.trace.empty() && options.truth.size() != 1)
    throw BadInput("--trace: is of one motion; give one --truth");
}

// displacement.K of the K-th character.
void write_trace(const JudgeOptions& options, const std::vector<Judged>& judged, size_t nodes) {
  if (options.trace.empty()) return;
  Safetensors file{.path = options.trace, .metadata = {{"sinew.trace", "1"}}, .tensors = {}};
  for (size_t c = 0; c < judged.size(); ++c) {
    const std::vector<float>& trace = judged[c].trace;
    file.tensors["displacement." + std::to_string(c)] =
        tensor_f32({trace.size() / (3 * nodes), nodes, 3}, trace);
  }
  write_safetensors(options.trace, file);
}

std::vector<LoadedPack> load_characters(const JudgeOptions& options) {
  std::vector<LoadedPack> characters;
  for (const std::string& path : options.characters) {
    characters.push_back(LoadedPack::from_file(path));
    if (characters.back().view().kind != pack::FileKind::kCharacter)
      throw BadInput(path + ": is a model without a character; give what sinew-bake character made");
  }
  return characters;
}

void check_all_judged(const JudgeOptions& options, const Judged& first) {
  for (size_t k = 0; k < options.ticks.size(); ++k) {
    if (first.sums[k].nodes > 0 && !(first.sums[k].skinning > 0))
      throw BadInput("--truth: nothing moves in these motions; give others");
  }
  if (std::ranges::all_of(first.sums, [](const Sums& sums) { return sums.nodes == 0; }))
    throw BadInput("--ticks: every motion is shorter; give fewer ticks or longer motions");
}

int run_judge(const JudgeOptions& options) {
  check_options(options);
  choose_isa(options.isa);
  const std::vector<LoadedPack> characters = load_characters(options);
  std::vector<Judged> judged;
  for (const std::string& path : options.characters)
    judged.push_back({.path = path, .sums = std::vector<Sums>(options.ticks.size()), .trace = {}});
  for (const std::string& truth : options.truth) follow(options, characters, truth, &judged);
  check_all_judged(options, judged.front());
  write_trace(options, judged, characters.front().view().nodes.size());
  const bool ok = within(options, judged);
  if (options.json)
    std::printf("%s\n", described(options, judged, ok).dump().c_str());
  else
    print_table(options, judged);
  return ok ? 0 : 1;
}

}  // namespace

void add_judge_command(CLI::App& app, int* exit_code) {
  auto options = std::make_shared<JudgeOptions>();
  CLI::App* command = app.add_subcommand(
      "judge",
      "Ticks characters along true motions as the runtime does; their errors, and what each adds to "
      "the first one's");
  command->add_option("characters", options->characters, "C.sinew...; the first is what others are held to")
      ->required();
  command->add_option("--truth", options->truth, "trajectories of sinew-bake truth")->required();
  command->add_option("--ticks", options->ticks, "roll-outs of so many ticks; by default 10 50 200 600");
  command
      ->add_option("--trace", options->trace,
                   "T.safetensors: displacement of the control nodes after every tick, [ticks + 1][nodes][3] "
                   "metres along their frames, of each character along one motion")
      ->group(kOutputs);
  command->add_option("--most-added", options->most_added,
                      "exit 1 where a character adds more than this fraction to the first one's error");
  command->add_option("--isa", options->isa, "an instruction set of this processor; the best by default");
  command->add_flag("--json", options->json, "one line for machines");
  command->callback([options, exit_code] { *exit_code = run_judge(*options); });
}

}  // namespace sinew::baker
