// pose_tape.cpp  see pose_tape.hpp.
#include "perf/frames/pose_tape.hpp"

#include <cmath>

namespace sinew::perf {
namespace {
constexpr double kRate_hz = 60;
}

PoseTape::PoseTape(const demo::CharacterFile& character, double seconds, const std::string& clip)
    : joint_count_(character.view.joints.size()),
      frames_(static_cast<size_t>(seconds * kRate_hz)),
      joints_(joint_count_ * frames_) {
  const std::unique_ptr<demo::Motion> motion = demo::make_motion(character, clip);
  RootTransform root;
  for (size_t f = 0; f < frames_; ++f)
    motion->pose_at(static_cast<double>(f) / kRate_hz, {&joints_[f * joint_count_], joint_count_}, &root);
}

std::span<const Matrix34> PoseTape::joints(double time_s) const {
  const auto frame = static_cast<size_t>(std::llround(time_s * kRate_hz)) % frames_;
  return {&joints_[frame * joint_count_], joint_count_};
}

}  // namespace sinew::perf
