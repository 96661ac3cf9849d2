// bake_judge.cpp  sinew-bake judge: characters against ground truth, in closed loop as the runtime ticks
// them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/progress.hpp"
#include "baker/programs/closed_loop.hpp"
#include "baker/programs/commands.hpp"

namespace sinew::baker {
namespace {

constexpr double kMillimetres = 1e3;

struct JudgeOptions {
  std::vector<std::string> characters, truth;
  std::vector<size_t> ticks = {10, 50, 200, 600};
  std::optional<double> most_added;
  std::string isa;
  bool json = false;
};

// ---- what is added up ----

// Distances of one character's nodes, over ticks 1 .. `ticks` of every motion that lasts so long.
struct Sums {
  double nodes = 0, error = 0, skinning = 0, apart = 0;  // apart: from the first character's

  void add(const float* u, const float* truth, const float* first) {
    const auto distance = [](const float* a, const float* b) {
      return std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]},
                        double{a[2]} - double{b[2]});
    };
    constexpr float kNowhere[3] = {};
    nodes += 1;
    error += distance(u, truth);
    skinning += distance(kNowhere, truth);
    apart += distance(u, first);
  }
  double mean_mm() const { return kMillimetres * error / nodes; }
  double ratio() const { return error / skinning; }
};

struct Judged {
  std::string path;
  std::vector<Sums> sums;  // one for each of the options' ticks
  uint32_t held = 0, fallbacks = 0;
};

void add_tick(const JudgeOptions& options, size_t tick, const TrueMotion& motion, const float* u,
              const float* first, size_t nodes, Judged* to) {
  for (size_t k = 0; k < options.ticks.size(); ++k) {
    if (tick > options.ticks[k] || options.ticks[k] > motion.ticks()) continue;
    for (size_t n = 0; n < nodes; ++n)
      to->sums[k].add(u + 3 * n, motion.displacement(tick) + 3 * n, first + 3 * n);
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
  std::vector<std::unique_ptr<ClosedLoop>> loops;
  for (const LoadedPack& character : characters)
    loops.push_back(std::make_unique<ClosedLoop>(character, motion));
  const size_t last = std::min(motion.ticks(), std::ranges::max(options.ticks));
  Progress progress("judging " + truth, last);
  for (size_t tick = 1; tick <= last; ++tick) {
    for (const auto& loop : loops) loop->tick();
    for (size_t c = 0; c < loops.size(); ++c)
      add_tick(options, tick, motion, loops[c]->displacement(), loops[0]->displacement(), nodes,
               &(*judged)[c]);
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
                                                              {"ratio", sums.ratio()},
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
    judged.push_back({path, std::vector<Sums>(options.ticks.size())});
  for (const std::string& truth : options.truth) follow(options, characters, truth, &judged);
  check_all_judged(options, judged.front());
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
  command->add_option("--most-added", options->most_added,
                      "exit 1 where a character adds more than this share to the first one's error");
  command->add_option("--isa", options->isa, "an instruction set of this processor; the best by default");
  command->add_flag("--json", options->json, "one line for machines");
  command->callback([options, exit_code] { *exit_code = run_judge(*options); });
}

}  // namespace sinew::baker
