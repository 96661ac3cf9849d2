// contact_response.cpp  see contact_response.hpp.
#include "tissue/modes/contact_response.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.hpp"
#include "tissue/modes/guard.hpp"

namespace sinew::tissue {
namespace {

// Sweeps end early once no contact asks for more than this share of the largest gap.
constexpr int kMostSweeps = 64;
constexpr float kSettled = 1e-4f;
constexpr float kHardly = 1e-3f;  // of the node that answers most

float dot3(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// What felt brings within the tick: modes' change into `modes`, the rest's and l's.
struct Response {
  const float *rest, *l;
  float modes[pack::kMaxModes];
};

void respond(const ModalBase& base, uint32_t first, uint32_t count, const float* felt, float* scratch,
             float* l, Response* out) {
  const simd::Kernels& kernels = simd::kernels();
  const size_t row = base.padded + base.padded_modes;
  kernels.add_rows(base.response + first * row, count, static_cast<uint32_t>(row), felt, scratch);
  const auto modes = static_cast<uint32_t>(base.modes.size());
  for (uint32_t k = 0; k < modes; ++k) out->modes[k] = base.modes[k].gain * scratch[base.padded + k];
  kernels.add_rows(base.shape, modes, base.padded, out->modes, l);
  for (uint32_t i = 0; i < base.padded; ++i) {
    scratch[i] *= base.rest_gain;
    l[i] += scratch[i];
  }
  out->rest = scratch;
  out->l = l;
}

// A, column by column.
struct Matrix {
  float at[kMostNodeContacts][kMostNodeContacts];
};

void fill(const ModalBase& base, std::span<const NodeContact> contacts, float* scratch, float* l,
          Matrix* matrix) {
  for (size_t j = 0; j < contacts.size(); ++j) {
    Response response;
    respond(base, 3 * contacts[j].node, 3, contacts[j].normal, scratch, l, &response);
    for (size_t i = 0; i < contacts.size(); ++i)
      matrix->at[i][j] = dot3(contacts[i].normal, l + size_t{3} * contacts[i].node);
  }
}

// Returns the largest change of a gap. A node that hardly answers, less than `least`, is not held: to move it
// would fling its neighbours. None is pressed by more than would move it alone by `most_m`: where frames hear
// of what others feel the matrix is not symmetric, and walls that leave no room have no answer; either would
// let presses grow with each sweep.
float sweep(const Matrix& matrix, float least, float most_m, std::span<NodeContact> contacts) {
  float largest = 0;
  for (size_t i = 0; i < contacts.size(); ++i) {
    if (!(matrix.at[i][i] > least)) continue;
    NodeContact& contact = contacts[i];
    float gap = contact.gap_m;
    for (size_t j = 0; j < contacts.size(); ++j) gap += matrix.at[i][j] * contacts[j].press;
    const float before = contact.press;
    const float wanted = std::max(0.0f, before - gap / matrix.at[i][i]);  // 0 where that is not a number
    contact.press = std::min(wanted, most_m / matrix.at[i][i]);
    largest = std::max(largest, std::fabs(contact.press - before) * matrix.at[i][i]);
  }
  return largest;
}

bool solve(const Matrix& matrix, float most_m, std::span<NodeContact> contacts) {
  float deepest = 0, most = 0;
  for (size_t i = 0; i < contacts.size(); ++i) {
    contacts[i].press = 0;
    deepest = std::max(deepest, -contacts[i].gap_m);
    most = std::max(most, matrix.at[i][i]);
  }
  if (!(deepest > 0 && most > 0)) return false;
  for (int k = 0; k < kMostSweeps && sweep(matrix, kHardly * most, most_m, contacts) > kSettled * deepest;
       ++k) {
  }
  return true;
}

}  // namespace

bool press(const ModalBase& base, float most_m, std::span<NodeContact> contacts, float* felt, float* scratch,
           float* answer, const ModalTick& tick) noexcept {
  Matrix matrix;
  fill(base, contacts, scratch, answer, &matrix);
  if (!solve(matrix, most_m, contacts)) return false;
  const uint32_t floats = 3 * base.node_count;
  std::fill_n(felt, floats, 0.0f);
  for (const NodeContact& contact : contacts) {
    for (size_t k = 0; k < 3; ++k) felt[3 * contact.node + k] += contact.press * contact.normal[k];
  }
  Response response;
  respond(base, 0, floats, felt, scratch, answer, &response);
  const float moved_m = largest_displacement_m(response.l, base.node_count);
  if (!std::isfinite(moved_m)) return false;
  const float share = moved_m > most_m ? most_m / moved_m : 1;
  for (size_t k = 0; k < base.modes.size(); ++k) tick.q[k] += share * response.modes[k];
  for (uint32_t i = 0; i < floats; ++i) {
    tick.r[i] += share * response.rest[i];
    tick.l[i] += share * response.l[i];
  }
  modal_turn(base, tick.q, scratch, tick.theta);
  warp(tick.theta, tick.l, base.node_count, tick.u);
  return true;
}

}  // namespace sinew::tissue
