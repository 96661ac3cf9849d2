// extremes.cpp  The long part: cases by the hundred thousand, on any packs, and a report of one screen.
//
// Each case is a number: of its scene, its pack and what is drawn. Exit status 1: something that was read was
// not finite, or beyond its bound.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "tests/extremes/scenes.hpp"
#include "tests/extremes/strands.hpp"
#include "tests/extremes/subjects.hpp"

using namespace sinew::extremes;

namespace {

constexpr double kMostDisplacement = 0.5, kMostReach = 1.02, kRounding = 1e-3;

struct Options {
  uint64_t cases = 2000, first = 1;
  uint32_t frames = 40, strand_every = 4, recovery_every = 20;
  bool lists = false;
  std::vector<std::string> packs;
};

struct Worst {
  double value = 0;
  uint64_t of_case = 0, cases = 0, bad = 0;

  void note(double read, bool good, uint64_t number) {
    ++cases;
    if (good ? bad == 0 && read > value : bad == 0 || read > value) value = read, of_case = number;
    bad += !good;
  }
};

struct Row {
  Worst reading, recovery;
};

class Run {
 public:
  explicit Run(const Options& options)
      : options_(options), rows_(all_scenes().size()), strands_(kStrandScenes) {
    for (const auto& built : built_subjects()) subjects_.push_back(built.get());
    for (const std::string& path : options.packs)
      subjects_.push_back(read_.emplace_back(std::make_unique<Subject>(path)).get());
  }

  void play_all() {
    for (uint64_t c = options_.first; c < options_.first + options_.cases; ++c) {
      play_character(c);
      if (c % options_.strand_every == 0) play_one_strand(c);
    }
  }

  void print() const {
    std::printf("%zu packs, cases %llu to %llu, %u frames each\n\n", subjects_.size(), number(options_.first),
                number(options_.first + options_.cases - 1), options_.frames);
    std::printf("%-20s %8s %4s %12s %9s | %10s %8s %9s %9s\n", "done to a character", "cases", "bad",
                "displacement", "of case", "recoveries", "not back", "left", "of case");
    for (size_t s = 0; s < rows_.size(); ++s) {
      const Row& row = rows_[s];
      std::printf("%-20s %8llu %4llu %12.4f %9llu | %10llu %8llu %9.4f %9llu\n", all_scenes()[s].name,
                  number(row.reading.cases), number(row.reading.bad), row.reading.value,
                  number(row.reading.of_case), number(row.recovery.cases), number(row.recovery.bad),
                  row.recovery.value, number(row.recovery.of_case));
    }
    std::printf("\n%-20s %8s %4s %12s %9s\n", "done to a strand", "cases", "bad", "reach", "of case");
    for (uint32_t s = 0; s < kStrandScenes; ++s)
      std::printf("%-20s %8llu %4llu %12.4f %9llu\n", strand_scene_name(s), number(strands_[s].cases),
                  number(strands_[s].bad), strands_[s].value, number(strands_[s].of_case));
    std::printf(
        "\ndisplacement: largest, share of the bind pose's largest extent (bound %g); reach: of a strand, "
        "share of its length "
        "(bound %g); bad: not played, not finite, beyond, or outside of World::bounds.\nleft: largest "
        "difference from an undisturbed "
        "twin when its "
        "slowest part has had time to swing down to a tenth, share of the height.\n",
        kMostDisplacement, kMostReach);
  }

  bool good() const {
    uint64_t bad = 0;
    for (const Row& row : rows_) bad += row.reading.bad;
    for (const Worst& strand : strands_) bad += strand.bad;
    return bad == 0;
  }

 private:
  static unsigned long long number(uint64_t n) { return n; }

  void play_character(uint64_t c) {
    const size_t s = c % all_scenes().size();
    const Scene& scene = all_scenes()[s];
    Subject& subject = *subjects_[c / all_scenes().size() % subjects_.size()];
    const Outcome outcome = play(subject, scene, c, options_.frames);
    const auto displacement = static_cast<double>(outcome.worst.displacement);
    const bool played = outcome.frames == options_.frames && outcome.worst.finite;
    const bool held = scene.deforms || static_cast<double>(outcome.worst.outside) <= kRounding;
    rows_[s].reading.note(displacement, played && held && displacement <= kMostDisplacement + kRounding, c);
    if (options_.lists && !held)
      std::printf("outside of its bounds: case %llu, %s, %s: by %.3f of the radius\n", number(c), scene.name,
                  subject.name.c_str(), static_cast<double>(outcome.worst.outside));
    if (c % options_.recovery_every != 0 || !subject.one_rest) return;
    const Recovery recovery = recover(subject, scene, c, options_.frames);
    rows_[s].recovery.note(static_cast<double>(recovery.left), recovery.is_back(), c);
    if (options_.lists && !recovery.is_back())
      std::printf("not back: case %llu, %s, %s: %.4f left of %.4f after %.2f s\n", number(c), scene.name,
                  subject.name.c_str(), static_cast<double>(recovery.left),
                  static_cast<double>(recovery.largest), static_cast<double>(recovery.wait_s));
  }

  void play_one_strand(uint64_t c) {
    const auto s = static_cast<uint32_t>(c / options_.strand_every % kStrandScenes);
    const StrandOutcome outcome = play_strand(s, c, options_.frames);
    strands_[s].note(outcome.reach, outcome.finite && outcome.reach <= kMostReach + kRounding, c);
  }

  Options options_;
  std::vector<Subject*> subjects_;
  std::vector<std::unique_ptr<Subject>> read_;
  std::vector<Row> rows_;
  std::vector<Worst> strands_;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Characters and strands at the extremes of what may be done to them");
  app.add_option("--cases", options.cases, "How many")->capture_default_str();
  app.add_option("--first", options.first, "The first case's number; with --cases 1 that one alone")
      ->capture_default_str();
  app.add_option("--frames", options.frames, "Of a case")->capture_default_str();
  app.add_option("--strand-every", options.strand_every, "Of so many cases one is of a strand as well")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--recovery-every", options.recovery_every,
                 "Of so many cases one is played beside an undisturbed twin")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_flag("--list", options.lists, "Name every case that is not back");
  app.add_option("packs", options.packs, "Baked characters, beside those that the tests make");
  CLI11_PARSE(app, argc, argv);
  try {
    Run run(options);
    run.play_all();
    run.print();
    return run.good() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "extremes: %s\n", error.what());
    return 1;
  }
}
