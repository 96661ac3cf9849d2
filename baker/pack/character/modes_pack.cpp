// modes_pack.cpp  Modal bases to the sections that modes run on.
#include "baker/pack/character/modes_pack.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/common/bad_input.hpp"

namespace sinew::baker {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using pack::SectionKind;

// Of a region without modes: the length of time that its inputs are told in; nothing of it moves.
constexpr double kUsual_rad_per_s = 2 * M_PI * 4, kUsualDampingRatio = 0.1;

void check_basis(const Region& region, const ModalBasis& basis) {
  const Index rows = 3 * region.node_count, modes = basis.rad_per_s.size();
  const bool fits = basis.damping_ratio.size() == modes && basis.shape.rows() == rows &&
                    basis.shape.cols() == modes && basis.turn.rows() == rows && basis.turn.cols() == modes &&
                    basis.force.rows() == modes && basis.force.cols() == rows && basis.rest.rows() == rows &&
                    basis.rest.cols() == rows;
  if (!fits || modes > kMostModes)
    throw BadInput("region '" + region.name + "': a modal basis of another shape, or of more than " +
                   std::to_string(kMostModes) + " modes");
  const bool good = basis.shape.allFinite() && basis.turn.allFinite() && basis.force.allFinite() &&
                    (basis.rad_per_s.array() > 0).all() && basis.rad_per_s.allFinite() &&
                    (basis.damping_ratio.array() >= 0).all() && basis.damping_ratio.allFinite() &&
                    basis.rest.allFinite() && basis.rest_rad_per_s >= 0 &&
                    std::isfinite(basis.rest_rad_per_s) && basis.rest_damping_ratio >= 0 &&
                    std::isfinite(basis.rest_damping_ratio) && (modes == 0 || basis.first_rad_per_s > 0) &&
                    std::isfinite(basis.first_rad_per_s) && basis.first_damping_ratio >= 0 &&
                    std::isfinite(basis.first_damping_ratio);
  if (!good)
    throw BadInput("region '" + region.name +
                   "': its modes hold numbers that are not finite; is the mesh damaged there?");
}

void append_row(const auto& row, std::vector<float>* out) {
  for (const double value : row) out->push_back(static_cast<float>(value));
  out->resize((out->size() + 15) / 16 * 16, 0.0f);
}

void append_rows(const MatrixXd& rows, std::vector<float>* out) {
  if (rows.size() == 0) return;  // rows of a matrix without numbers lie nowhere
  for (const auto& row : rows.rowwise()) append_row(row, out);
}

MatrixXd projection(const ModalBasis& basis) {
  if (basis.shape.size() == 0) return basis.shape.transpose();
  const double nodes = static_cast<double>(basis.shape.rows()) / 3;
  MatrixXd square = basis.shape.transpose() * basis.shape;
  square.diagonal() += kRidge * nodes * (basis.rad_per_s / basis.rad_per_s[0]).cwiseAbs2();
  return square.ldlt().solve(basis.shape.transpose());
}

// Every row begins at a multiple of 16.
void append_matrices(const ModalBasis& basis, std::vector<float>* out) {
  append_rows(basis.shape.transpose(), out);
  append_rows(basis.turn.transpose(), out);
  for (Index i = 0; i < basis.shape.rows(); ++i) {
    append_row(basis.rest.col(i), out);
    append_row(basis.force.col(i), out);
  }
  append_rows(projection(basis).transpose(), out);
}

pack::ModeRecord mode_record(double rad_per_s, double damping_ratio, double rate_hz) {
  const Recurrence r = modal_recurrence(rad_per_s, damping_ratio, rate_hz);
  return {static_cast<float>(rad_per_s), static_cast<float>(damping_ratio), r.a1, r.a2, r.gain, {}};
}

struct Sections {
  std::vector<pack::RegionModesRecord> regions;
  std::vector<pack::ModeRecord> modes;
  std::vector<float> matrices;
};

void append_region(const Region& region, const ModalBasis& basis, double rate_hz, Sections* to) {
  const bool moves = basis.rad_per_s.size() > 0;
  const double first = moves ? basis.first_rad_per_s : kUsual_rad_per_s;
  pack::RegionModesRecord record{};
  record.first_mode = static_cast<uint32_t>(to->modes.size());
  record.mode_count = static_cast<uint32_t>(basis.rad_per_s.size());
  record.matrices = to->matrices.size();
  record.padded = static_cast<uint32_t>((3 * region.node_count + 15) / 16 * 16);
  record.first_rad_per_s = static_cast<float>(first);
  const Recurrence rest = modal_recurrence(basis.rest_rad_per_s, basis.rest_damping_ratio, rate_hz);
  record.rest_a1 = rest.a1;
  record.rest_a2 = rest.a2;
  record.rest_gain = 1 - rest.a1 - rest.a2;
  const Recurrence swing =
      modal_recurrence(first, moves ? basis.first_damping_ratio : kUsualDampingRatio, rate_hz);
  record.first_a1 = swing.a1;
  record.first_a2 = swing.a2;
  to->regions.push_back(record);
  for (Index k = 0; k < basis.rad_per_s.size(); ++k)
    to->modes.push_back(mode_record(basis.rad_per_s[k], basis.damping_ratio[k], rate_hz));
  append_matrices(basis, &to->matrices);
}

}  // namespace

Recurrence modal_recurrence(double rad_per_s, double damping_ratio, double rate_hz) {
  if (rad_per_s == 0) return {};
  const double swung = rad_per_s / rate_hz, decay = damping_ratio * swung;
  const double below = 1 - damping_ratio * damping_ratio, root = std::sqrt(std::abs(below)) * swung;
  Recurrence r;
  if (below < 0) {
    r.a1 = static_cast<float>(std::exp(root - decay) + std::exp(-root - decay));
    r.a2 = static_cast<float>(-std::exp(-2 * decay));
  } else if (root < std::numbers::pi) {
    r.a1 = static_cast<float>(2 * std::exp(-decay) * std::cos(root));
    r.a2 = std::max(std::nextafter(-1.0f, 0.0f), static_cast<float>(-std::exp(-2 * decay)));
  }
  r.gain = static_cast<float>((1 - double{r.a1} - double{r.a2}) / (rad_per_s * rad_per_s));
  return r;
}

void check_modes(const TissueLayout& layout, const std::vector<ModalBasis>& modes) {
  if (modes.size() != layout.regions.size())
    throw BadInput("modal bases: " + std::to_string(modes.size()) + " for " +
                   std::to_string(layout.regions.size()) + " regions");
  for (size_t r = 0; r < modes.size(); ++r) check_basis(layout.regions[r], modes[r]);
}

uint64_t add_modes(const TissueLayout& layout, const std::vector<ModalBasis>& modes, double rate_hz,
                   bool first, PackWriter& pack) {
  check_modes(layout, modes);
  Sections sections;
  for (size_t r = 0; r < modes.size(); ++r) append_region(layout.regions[r], modes[r], rate_hz, &sections);
  pack.append(SectionKind::kRegionModes, sections.regions);
  pack.append(SectionKind::kModeMatrices, sections.matrices);
  if (first) {
    pack.section(SectionKind::kModes, sections.modes);
  }
  return sections.matrices.size();
}

}  // namespace sinew::baker
