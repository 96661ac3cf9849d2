// test_demo.cpp  sinew-demo as a user calls it: pictures and reports that are there, bad input refused in one
// line.
#include <stb/stb_image.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "baker/common/files/safetensors.hpp"
#include "baker/truth/trajectory.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/run_program.hpp"
#include "tests/pack/small_pack.hpp"
#include "tests/scenes/motions.hpp"
#include "tests/scenes/soft_block.hpp"

using namespace sinew;
using sinew::test::ProgramResult;
using sinew::test::TemporaryFolder;

namespace {

ProgramResult demo(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SINEW_DEMO);
  return test::run_program(arguments);
}

void check_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  const ProgramResult result = demo(arguments);
  INFO(result.error);
  CHECK(result.exit_code == 2);
  CHECK(result.out.empty());
  CHECK_THAT(result.error, Catch::StartsWith("sinew-demo: "));
  CHECK(result.error.find('\n') == result.error.size() - 1);
  for (const std::string& word : words) CHECK_THAT(result.error, Catch::Contains(word));
}

void write_bytes(const std::string& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
}

std::string write_block(const TemporaryFolder& folder) {
  const std::string path = folder.file("block.sinew");
  write_bytes(path, scenes::soft_block().bytes());
  return path;
}

// A truth of half a second in which the block walks and its surface, in character space, is all at one place.
constexpr size_t kRows = 31, kBlockVertices = 462;
baker::Safetensors flat_truth() {
  std::vector<float> joints, root, positions(kRows * kBlockVertices * 3, 0.25f);
  for (size_t row = 0; row < kRows; ++row) {
    const scenes::BlockPose pose = scenes::walk(static_cast<double>(row) / 60);
    for (const Matrix34& joint : pose.joints)
      joints.insert(joints.end(), &joint.m[0][0], &joint.m[0][0] + 12);
    for (const double x : pose.root.position_m) root.push_back(static_cast<float>(x));
    root.insert(root.end(), pose.root.rotation_xyzw, pose.root.rotation_xyzw + 4);
  }
  baker::Safetensors file;
  file.metadata = {{"sinew.trajectory", baker::kTrajectoryVersion}, {"rate_hz", "60"}, {"motion", "walk"}};
  file.tensors["joints"] = baker::tensor_f32({kRows, 2, 12}, joints);
  file.tensors["root"] = baker::tensor_f32({kRows, 7}, root);
  file.tensors["positions"] = baker::tensor_f32({kRows, kBlockVertices, 3}, positions);
  return file;
}

void check_picture(const std::string& path) {
  INFO(path);
  int width = 0, height = 0, channels = 0;
  uint8_t* pixels = stbi_load(path.c_str(), &width, &height, &channels, 3);
  REQUIRE(pixels != nullptr);
  CHECK((width > 100 && height > 60));
  CHECK(std::adjacent_find(pixels, pixels + 3 * width * height, std::not_equal_to<>()) !=
        pixels + 3 * width * height);
  stbi_image_free(pixels);
}

// How often each name begins, of a trace whose begins and ends are checked on the way: in pairs, nested,
// later and later on each thread.
std::map<std::string, int> begun_in(const nlohmann::json& trace) {
  struct Thread {
    std::vector<std::pair<std::string, int>> open;
    double now_us = 0;
  };
  std::map<int, Thread> threads;
  std::map<std::string, int> begun;
  for (const auto& event : trace["traceEvents"]) {
    Thread& thread = threads[event["tid"].get<int>()];
    const std::pair<std::string, int> what{event["name"], event["args"]["instance"].get<int>()};
    const double at_us = event["ts"];
    CHECK(at_us >= thread.now_us);
    CHECK(event["pid"] == 1);
    thread.now_us = at_us;
    if (event["ph"] == "B") {
      ++begun[what.first];
      thread.open.push_back(what);
      continue;
    }
    CHECK(event["ph"] == "E");
    REQUIRE_FALSE(thread.open.empty());
    CHECK(thread.open.back() == what);
    thread.open.pop_back();
  }
  for (const auto& [number, thread] : threads) CHECK(thread.open.empty());
  return begun;
}

std::string formatted(const char* format, double value) {
  char out[64];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

bool has_ffmpeg() { return test::run_program({"/usr/bin/env", "ffmpeg", "-version"}).exit_code == 0; }

}  // namespace

TEST_CASE("outputs_that_are_the_pack_are_refused") {
  const TemporaryFolder folder;
  const std::string pack = write_block(folder), still = folder.file("still.png");
  check_refused({pack, "--report", pack}, {pack, "is the input; give another name"});
  check_refused({pack, "--trace", folder.file("./block.sinew")}, {"is the input; give another name"});
  std::filesystem::create_symlink(pack, still);
  check_refused({pack, "--frames", still.substr(0, still.rfind('/'))},
                {still, "is the input; give another name"});
}

TEST_CASE("demo_refuses_packs_it_cannot_play") {
  TemporaryFolder folder;
  check_refused({}, {"pack"});
  check_refused({folder.file("none.sinew")}, {"none.sinew"});
  const std::vector<std::byte> whole = test::small_character_pack();
  write_bytes(folder.file("cut.sinew"), std::span(whole).first(whole.size() / 2));
  check_refused({folder.file("cut.sinew")}, {"cut.sinew"});
  write_bytes(folder.file("empty.sinew"), {});
  check_refused({folder.file("empty.sinew")}, {"empty.sinew"});
  write_bytes(folder.file("model.sinew"), test::small_model());
  check_refused({folder.file("model.sinew")}, {"without a character"});
}

TEST_CASE("demo_refuses_numbers_outside_their_range") {
  TemporaryFolder folder;
  const std::string block = write_block(folder);
  for (const char* budget : {"0", "-5", "nan", "inf", "much"})
    check_refused({block, "--budget-us", budget}, {"--budget-us", "above 0"});
  for (const char* count : {"0", "-1", "1000000000", "2.5"})
    check_refused({block, "--instances", count}, {"--instances"});
  for (const char* seconds : {"0", "-1", "nan"}) check_refused({block, "--seconds", seconds}, {"--seconds"});
  check_refused({block, "--fps", "0"}, {"--fps"});
  check_refused({block, "--threads", "0"}, {"--threads"});
  check_refused({block, "--width", "3"}, {"--width"});
  check_refused({block, "--seconds", "86400", "--fps", "1000"}, {"million frames"});
  check_refused({block, "--speed", "3"}, {"--speed"});
  check_refused({block, "--clip", "hop"}, {"hop", "it has none"});
}

TEST_CASE("demo_refuses_a_truth_that_does_not_fit") {
  TemporaryFolder folder;
  const std::string block = write_block(folder), path = folder.file("truth.safetensors");
  check_refused({block, "--truth", folder.file("none.safetensors")}, {"none.safetensors"});
  check_refused({block, "--truth", block}, {"block.sinew"});
  baker::Safetensors file = flat_truth();
  file.metadata.erase("sinew.trajectory");
  baker::write_safetensors(path, file);
  check_refused({block, "--truth", path}, {"not a trajectory"});
  file = flat_truth();
  file.metadata["sinew.trajectory"] = "1";
  baker::write_safetensors(path, file);
  check_refused({block, "--truth", path}, {"another version", "simulate it again"});
  file = flat_truth();
  file.tensors.erase("positions");
  baker::write_safetensors(path, file);
  check_refused({block, "--truth", path}, {"--positions"});
  file = flat_truth();
  file.tensors["positions"] = baker::tensor_f32({kRows, 4, 3}, std::vector<float>(kRows * 12));
  baker::write_safetensors(path, file);
  check_refused({block, "--truth", path}, {"positions"});
  file = flat_truth();
  file.tensors["root"] = baker::tensor_f32({kRows, 7}, std::vector<float>(kRows * 7, std::nanf("")));
  baker::write_safetensors(path, file);
  check_refused({block, "--truth", path}, {"root", "not finite"});
}

TEST_CASE("demo_refuses_places_it_cannot_write_to") {
  TemporaryFolder folder;
  const std::string block = write_block(folder);
  const std::string file = folder.file("file");
  write_bytes(file, {});
  check_refused({block, "--frames", file}, {file, "cannot be made a folder"});
  for (const char* option : {"--report", "--trace"}) {
    const ProgramResult result = demo({block, "--seconds", "0.1", option, folder.file("none/out.json")});
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.error, Catch::Contains("out.json"));
  }
}

TEST_CASE("demo_prints_a_table_and_nothing_else_in_a_pipe") {
  TemporaryFolder folder;
  const ProgramResult result = demo(
      {write_block(folder), "--instances", "3", "--seconds", "0.5", "--budget-us", "5000", "--threads", "2"});
  CHECK(result.exit_code == 0);
  CHECK(result.error.empty());
  CHECK(result.out.find('\r') == std::string::npos);
  for (const char* word : {"soft_block", "462 vertices", "3 instances", "budget 5000 us", "schedule",
                           "tissue", "network", "over budget in"}) {
    CHECK_THAT(result.out, Catch::Contains(word));
  }
}

TEST_CASE("demo_report_holds_every_frame") {
  TemporaryFolder folder;
  const std::string path = folder.file("report.json");
  REQUIRE(demo({write_block(folder), "--instances", "2", "--seconds", "0.5", "--fps", "30", "--report", path})
              .exit_code == 0);
  const auto report = nlohmann::json::parse(std::ifstream(path));
  CHECK(report["instances"] == 2);
  CHECK(report["budget_us"].is_null());
  REQUIRE(report["frames"].size() == 16);
  for (const auto& frame : report["frames"]) {
    CHECK(frame["ticks"].get<int>() <= 4);
    CHECK(frame["network"].get<int>() + frame["modal"].get<int>() + frame["extrapolated"].get<int>() +
              frame["skinning"].get<int>() ==
          2);
    CHECK(frame["total_us"].get<double>() > 0);
    CHECK(frame["first"]["tier"] == "network");
  }
}

TEST_CASE("demo_tells_why_and_what_is_left_unspent_as_its_frames_have_it") {
  TemporaryFolder folder;
  const std::string path = folder.file("report.json");
  const ProgramResult result = demo(
      {write_block(folder), "--instances", "40", "--seconds", "1", "--budget-us", "300", "--report", path});
  REQUIRE(result.exit_code == 0);
  const auto report = nlohmann::json::parse(std::ifstream(path));
  const auto& summary = report["summary"];
  double why = 0, unspent = 0;
  int denied = 0;
  for (const auto& [name, share] : summary["why"].items()) {
    why += share.get<double>();
    CHECK_THAT(result.out, Catch::Contains(" " + name + formatted(" %.1f %%", 100 * share.get<double>())));
  }
  for (const auto& frame : report["frames"]) {
    denied += frame["unspent_us"] > 0;
    unspent += frame["unspent_us"].get<double>() / frame["budget_us"].get<double>();
  }
  CHECK(why == Approx(1));
  CHECK(summary["expected_error"].is_null());  // of no tier of the block an error was measured
  CHECK(summary["unspent"]["mean"].get<double>() == Approx(denied > 0 ? unspent / denied : 0));
  const double median = 100 * summary["unspent"]["median"].get<double>();
  CHECK_THAT(result.out, Catch::Contains("skinning's: not measured") &&
                             Catch::Contains(formatted("one was denied: median %.1f %%", median)));
}

TEST_CASE("demo_tells_how_far_each_part_goes") {
  TemporaryFolder folder;
  const std::string pack = folder.file("tailed.sinew"), path = folder.file("report.json");
  write_bytes(pack, scenes::soft_block({.rods = scenes::RodMatter{.bar = true}}).bytes());
  const ProgramResult result = demo({pack, "--seconds", "1", "--report", path});
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out,
             Catch::Contains("most moved, mm") && Catch::Contains("contacts with its body colliders"));
  const auto report = nlohmann::json::parse(std::ifstream(path));
  CHECK(report["own_body_contacts"] == true);
  REQUIRE(report["parts"].size() == 5);
  for (const auto& part : report["parts"]) {
    CHECK_THAT(result.out, Catch::Contains(part["name"].get<std::string>()));
    CHECK(part["frequency_hz"] > 0);
    const double largest_mm = part["largest_mm"];
    CHECK(largest_mm > 1);
    CHECK(part["largest_of_height"].get<double>() * 600 ==
          Approx(largest_mm).epsilon(0.4));  // tail and horns, too
    CHECK(part["still_mm"].get<double>() < largest_mm);
  }
  const ProgramResult without = demo({pack, "--seconds", "0.2", "--no-contacts"});
  CHECK_THAT(without.out, Catch::Contains("no contacts"));
}

TEST_CASE("demo_refuses_to_compare_what_is_not_one_character") {
  TemporaryFolder folder;
  const std::string block = write_block(folder), other = folder.file("other.sinew");
  check_refused({block, "--compare", folder.file("none.sinew")}, {"none.sinew"});
  write_bytes(other, scenes::soft_block({.cells = 8}).bytes());
  check_refused({block, "--compare", other}, {"other.sinew", "vertices instead of 462", "bake both"});
  write_bytes(other, scenes::soft_block({.rods = scenes::RodMatter{}}).bytes());
  check_refused({block, "--compare", other}, {"12 joints instead of 2"});
  check_refused({block, "--compare", block, "--truth", "t"}, {"--compare", "--truth"});
  check_refused({block, "--view", "top"}, {"--view"});
}

TEST_CASE("demo_compares_two_packs_of_a_character_in_its_table_report_and_pictures") {
  TemporaryFolder folder;
  const std::string block = write_block(folder), other = folder.file("one_part.sinew"),
                    path = folder.file("report.json"), frames = folder.file("frames");
  write_bytes(other, scenes::soft_block({.regions = 1, .network = false}).bytes());
  const ProgramResult result =
      demo({block, "--compare", other, "--seconds", "0.5", "--report", path, "--frames", frames, "--width",
            "64", "--height", "64", "--samples", "1", "--view", "back"});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("  block ") && Catch::Contains("  one_part "));
  const auto report = nlohmann::json::parse(std::ifstream(path));
  CHECK(report["parts"].size() == 2);
  CHECK(report["compared"]["name"] == "one_part");
  CHECK(report["compared"]["parts"].size() == 1);
  for (const char* name : {"contact_sheet.png", "still.png"}) check_picture(frames + "/" + name);
}

TEST_CASE("demo_makes_a_film_only_when_asked_and_leaves_no_older_one") {
  TemporaryFolder folder;
  const std::string block = write_block(folder), frames = folder.file("frames");
  std::filesystem::create_directories(frames);
  for (const char* old : {"frame_0000.png", "animation.mp4", "animation.gif"})
    std::ofstream(frames + "/" + old) << "of an earlier run";
  REQUIRE(
      demo({block, "--seconds", "0.2", "--frames", frames, "--width", "64", "--height", "64"}).exit_code ==
      0);
  for (const char* name : {"contact_sheet.png", "still.png"}) check_picture(frames + "/" + name);
  for (const char* old : {"frame_0000.png", "animation.mp4", "animation.gif"})
    CHECK_FALSE(std::filesystem::exists(frames + "/" + old));
}

TEST_CASE("demo_traces_each_stage_of_each_frame_and_instance") {
  TemporaryFolder folder;
  const std::string path = folder.file("trace.json");
  REQUIRE(
      demo({write_block(folder), "--instances", "3", "--threads", "2", "--seconds", "0.5", "--trace", path})
          .exit_code == 0);
  const std::map<std::string, int> begun = begun_in(nlohmann::json::parse(std::ifstream(path)));
  constexpr int kFrames = 31, kInstances = 3;
  for (const char* stage : {"schedule", "report"}) CHECK(begun.at(stage) == kFrames);
  for (const char* stage : {"instance", "drive", "tissue", "rods", "publish"})
    CHECK(begun.at(stage) == kFrames * kInstances);
  CHECK(begun.size() == 7);
}

TEST_CASE("demo_traces_the_last_300_frames_of_a_longer_run") {
  TemporaryFolder folder;
  const std::string path = folder.file("trace.json");
  REQUIRE(demo({write_block(folder), "--seconds", "6", "--trace", path}).exit_code == 0);
  const auto trace = nlohmann::json::parse(std::ifstream(path));
  const std::map<std::string, int> begun = begun_in(trace);
  CHECK(begun.at("schedule") == 300);
  CHECK(begun.at("instance") == 300);
  CHECK(trace["traceEvents"][0]["ts"] == 0);
}

TEST_CASE("demo_measures_sinew_and_skinning_against_the_truth") {
  TemporaryFolder folder;
  const std::string block = write_block(folder), truth = folder.file("truth.safetensors"),
                    path = folder.file("report.json");
  baker::write_safetensors(truth, flat_truth());
  const ProgramResult result = demo({block, "--truth", truth, "--report", path});
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("against truth") && Catch::Contains("skinning alone"));
  const auto report = nlohmann::json::parse(std::ifstream(path));
  CHECK(report["frames"].size() == kRows);
  // The truth's surface is one point 0.25 m from the origin on each axis; the soft half of the block lies up
  // to 0.6 m away.
  for (const auto& frame : report["frames"]) {
    for (const char* which : {"skinning", "sinew"}) {
      const double error_mm = frame["error_mm"][which];
      CHECK((error_mm > 100 && error_mm < 600));
    }
  }
}

TEST_CASE("demo_leaves_pictures_that_can_be_looked_at") {
  TemporaryFolder folder;
  const std::string block = write_block(folder), truth = folder.file("truth.safetensors"),
                    frames = folder.file("frames");
  baker::write_safetensors(truth, flat_truth());
  std::filesystem::create_directories(frames);
  std::ofstream(frames + "/frame_0099.png") << "of an earlier run";
  const ProgramResult result =
      demo({block, "--truth", truth, "--seconds", "0.2", "--instances", "2", "--frames", frames, "--width",
            "64", "--height", "64", "--samples", "1", "--picture-fps", "15"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.error.find('\r') == std::string::npos);
  for (const char* name : {"frame_0000.png", "frame_0003.png", "contact_sheet.png", "still.png", "crowd.png"})
    check_picture(frames + "/" + name);
  CHECK_FALSE(std::filesystem::exists(frames + "/frame_0004.png"));
  CHECK_FALSE(std::filesystem::exists(frames + "/frame_0099.png"));
  if (!has_ffmpeg()) {
    WARN("skipped: no film was looked for, ffmpeg is not installed");
    CHECK_THAT(result.error, Catch::Contains("ffmpeg is not installed"));
    return;
  }
  CHECK(result.error.empty());
  for (const char* name : {"animation.mp4", "animation.gif"})
    CHECK(std::filesystem::file_size(frames + "/" + name) > 1000);
}
