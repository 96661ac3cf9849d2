// rod_run.cpp  Steps a scene by the direct solver at a tight tolerance and keeps what it found.
#include "baker/rods/rod_run.hpp"

#include <algorithm>

#include "baker/common/bad_input.hpp"
#include "rods/section.hpp"

namespace sinew::baker {
namespace {

struct Units {
  double length_m = 0, mass_kg = 0;
  explicit Units(const std::vector<rods::SegmentDef>& segments) {
    for (const rods::SegmentDef& s : segments) {
      length_m += static_cast<double>(s.length_m) / static_cast<double>(segments.size());
      mass_kg += rods::segment_inertia(s).mass_kg / static_cast<double>(segments.size());
    }
  }
};

struct Record {
  std::vector<float> forces, turns, inputs, continued, scales, joints;
  std::vector<int32_t> iterations;

  void add_forces(const rods::RodBatch& batch, const Units& units) {
    const double force = units.mass_kg * units.length_m;
    const auto add = [&](const float(&v)[3], double per) {
      for (const float x : v) forces.push_back(static_cast<float>(static_cast<double>(x) / per));
    };
    for (uint32_t i = 0; i < batch.segment_count(); ++i) {
      const rods::SegmentStart now = batch.last_forces(0, i);
      add(now.acceleration_m_s2, units.length_m);
      add(now.angular_acceleration_rad_s2, 1);
      add(now.force_n, force);
      add(now.moment_nm, force * units.length_m);
    }
  }
  void add_inputs(const rods::RodBatch& batch) {
    for (uint32_t i = 0; i < batch.segment_count(); ++i) {
      const rods::StartInputs now = batch.start_inputs(0, i);
      inputs.insert(inputs.end(), std::begin(now.told), std::end(now.told));
      continued.insert(continued.end(), std::begin(now.continued), std::end(now.continued));
      if (i == 0) scales.insert(scales.end(), std::begin(now.scales), std::end(now.scales));
    }
  }
  void add_turns(const rods::RodBatch& batch) {
    for (uint32_t i = 0; i < batch.segment_count(); ++i) {
      const rods::SegmentPose pose = batch.pose(0, i);
      turns.insert(turns.end(), pose.orientation, pose.orientation + 4);
    }
  }
};

std::string name_of(const RodLine& line, uint64_t seed) {
  return line.scene + " " + line.split + " " + std::to_string(seed);
}

rods::RodBatch make_batch(const RodScene& scene, const RodPlan& plan, const std::string& name) {
  rods::RodSettings settings = {.start = rods::RodStart::kContinued, .max_iterations = 200};
  settings.tolerance_rad = static_cast<float>(plan.tolerance_rad);
  settings.keeps_start_inputs = true;
  const rods::StrandDef strand{scene.segments};
  rods::RodBatch batch;
  const Status status = rods::RodBatch::create({&strand, 1}, settings, &batch);
  if (!status.ok()) throw BadInput(name + ": " + status.message);
  return batch;
}

std::vector<int32_t> parents_of(const RodScene& scene) {
  std::vector<int32_t> parents = {0};
  for (size_t i = 1; i < scene.segments.size(); ++i) {
    parents.push_back(static_cast<int32_t>(scene.segments[i].parent));
  }
  return parents;
}

}  // namespace

void drive_root(const RodScene& scene, double time_s, uint32_t strand, rods::RodBatch* batch) {
  const Status status = batch->set_target(strand, 0, scene.motion.at(time_s));
  if (!status.ok()) throw BadInput(std::string("the root's motion: ") + status.message);
}

Safetensors simulate_rod(const RodLine& line, const RodPlan& plan, uint64_t seed) {
  const std::string name = name_of(line, seed);
  const RodScene scene = make_rod_scene(line.range, seed);
  const Units units(scene.segments);
  rods::RodBatch batch = make_batch(scene, plan, name);
  Record record;
  record.add_forces(batch, units);
  for (uint32_t i = 0; i < batch.segment_count(); ++i) {
    const rods::StartInputs now = batch.start_inputs(0, i);
    record.joints.insert(record.joints.end(), std::begin(now.joint), std::end(now.joint));
  }
  for (uint32_t step = 0; step < line.steps; ++step) {
    record.add_turns(batch);
    drive_root(scene, (step + 1) * plan.dt_s, 0, &batch);
    rods::RodReport report;
    batch.step(static_cast<float>(plan.dt_s), &report);
    if (report.unconverged + report.recovered > 0) {
      throw NoTruth(name + ": step " + std::to_string(step) + " does not converge");
    }
    record.add_forces(batch, units);
    record.add_inputs(batch);
    record.iterations.push_back(static_cast<int32_t>(report.iterations));
  }
  const size_t s = line.steps, n = scene.segments.size();
  const rods::SegmentDef& root = scene.segments[0];
  Safetensors out;
  out.metadata = {{"scene", line.scene},
                  {"split", line.split},
                  {"rods", std::to_string(line.range.rods)},
                  {"seed", std::to_string(seed)},
                  {"dt_s", std::to_string(plan.dt_s)},
                  {"tolerance_rad", std::to_string(plan.tolerance_rad)},
                  {"young_pa", std::to_string(root.young_modulus_pa)},
                  {"torsion_pa", std::to_string(root.torsion_modulus_pa)}};
  out.tensors["forces"] = tensor_f32({s + 1, n, 12}, record.forces);
  out.tensors["turns"] = tensor_f32({s, n, 4}, record.turns);
  out.tensors["inputs"] = tensor_f32({s, n, simd::kRodStartInputs}, record.inputs);
  out.tensors["continued"] = tensor_f32({s, n, simd::kRodStartNumbers}, record.continued);
  out.tensors["scales"] = tensor_f32({s, simd::kRodStartTriples}, record.scales);
  out.tensors["joints"] = tensor_f32({n, simd::kRodJointInputs}, record.joints);
  out.tensors["iterations"] = tensor_i32({s}, record.iterations);
  out.tensors["parents"] = tensor_i32({n}, parents_of(scene));
  return out;
}

}  // namespace sinew::baker
