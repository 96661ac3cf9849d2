// fem_elements.cpp  Linear tetrahedra, eight at a time: energy, stress, force and stiffness.
#include "baker/truth/fem/fem_elements.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>

#include "baker/truth/numerics/polar.hpp"

namespace sinew::baker {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Matrix9 = Eigen::Matrix<double, 9, 9>;  // of vec(F), column-major

// Smith et al. 2018: their mu and lambda from Lame's, and the J at which the bracket of eq. 14 rests.
template <typename T>
struct StableNeoHookean {
  T mu, lambda, rest_volume;
  StableNeoHookean(const T& lame_mu, const T& lame_lambda)
      : mu(lame_mu * (4.0 / 3.0)),
        lambda(lame_lambda + lame_mu * (5.0 / 6.0)),
        rest_volume(1.0 + 0.75 * mu / lambda) {}
};

LaneMatrix cofactor(const LaneMatrix& f) {
  LaneMatrix c;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      const size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c[i][j] = f[i1][j1] * f[i2][j2] - f[i1][j2] * f[i2][j1];
    }
  return c;
}

Lanes squared_norm(const LaneMatrix& f) {
  Lanes sum = Lanes::Zero();
  for (const auto& row : f)
    for (const Lanes& value : row) sum += value * value;
  return sum;
}

Lanes determinant(const LaneMatrix& f, const LaneMatrix& c) {
  return f[0][0] * c[0][0] + f[0][1] * c[0][1] + f[0][2] * c[0][2];
}

Matrix3 lane_of(const LaneMatrix& f, int lane) {
  Matrix3 one;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) one(i, j) = f[static_cast<size_t>(i)][static_cast<size_t>(j)][lane];
  return one;
}

LaneMatrix rotations(const LaneMatrix& f) {
  LaneMatrix r;
  for (int lane = 0; lane < kLanes; ++lane) {
    const Matrix3 one = nearest_rotation(lane_of(f, lane));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r[static_cast<size_t>(i)][static_cast<size_t>(j)][lane] = one(i, j);
  }
  return r;
}

// R^T F - I, symmetric part.
LaneStrain strain_against(const LaneMatrix& r, const LaneMatrix& f) {
  const auto product = [&](size_t i, size_t j) -> Lanes {
    return r[0][i] * f[0][j] + r[1][i] * f[1][j] + r[2][i] * f[2][j];
  };
  return {product(0, 0) - 1.0,
          product(1, 1) - 1.0,
          product(2, 2) - 1.0,
          0.5 * (product(0, 1) + product(1, 0)),
          0.5 * (product(1, 2) + product(2, 1)),
          0.5 * (product(2, 0) + product(0, 2))};
}

LaneStrain small_strain(const LaneMatrix& f) {
  return {f[0][0] - 1.0,
          f[1][1] - 1.0,
          f[2][2] - 1.0,
          0.5 * (f[0][1] + f[1][0]),
          0.5 * (f[1][2] + f[2][1]),
          0.5 * (f[2][0] + f[0][2])};
}

LaneStrain green_strain(const LaneMatrix& f) {
  const auto product = [&](size_t i, size_t j) -> Lanes {
    return f[0][i] * f[0][j] + f[1][i] * f[1][j] + f[2][i] * f[2][j];
  };
  return {0.5 * (product(0, 0) - 1.0), 0.5 * (product(1, 1) - 1.0), 0.5 * (product(2, 2) - 1.0),
          0.5 * product(0, 1),         0.5 * product(1, 2),         0.5 * product(2, 0)};
}

// Hooke's law: the symmetric 2 mu e + lambda tr(e) I.
LaneStrain hooke(const ElementBlock& block, const LaneStrain& e) {
  const Lanes pressure = block.lambda * (e[0] + e[1] + e[2]), twice = 2.0 * block.mu;
  return {twice * e[0] + pressure,
          twice * e[1] + pressure,
          twice * e[2] + pressure,
          twice * e[3],
          twice * e[4],
          twice * e[5]};
}

Lanes hooke_energy(const ElementBlock& block, const LaneStrain& e) {
  const Lanes trace = e[0] + e[1] + e[2];
  return block.mu * (e[0].square() + e[1].square() + e[2].square() +
                     2.0 * (e[3].square() + e[4].square() + e[5].square())) +
         0.5 * block.lambda * trace.square();
}

LaneMatrix full(const LaneStrain& s) {
  return {{{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}}};
}

LaneMatrix product(const LaneMatrix& a, const LaneMatrix& b) {
  LaneMatrix c;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) c[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
  return c;
}

LaneMatrix neo_hookean_stress(const ElementBlock& block, const LaneMatrix& f) {
  const StableNeoHookean<Lanes> m(block.mu, block.lambda);
  LaneMatrix p = cofactor(f);
  const Lanes pressure = m.lambda * (determinant(f, p) - m.rest_volume);
  const Lanes shear = m.mu * (1.0 - 1.0 / (squared_norm(f) + 1.0));
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) p[i][j] = shear * f[i][j] + pressure * p[i][j];
  return p;
}

Lanes neo_hookean_energy(const ElementBlock& block, const LaneMatrix& f) {
  const StableNeoHookean<Lanes> m(block.mu, block.lambda);
  const Lanes j = determinant(f, cofactor(f)), stretch = squared_norm(f);
  const Lanes volume = 0.5 * m.lambda * ((j - m.rest_volume).square() - (1.0 - m.rest_volume).square());
  return 0.5 * m.mu * (stretch - 3.0) + volume - 0.5 * m.mu * ((stretch + 1.0) * 0.25).log();
}

}  // namespace

std::vector<ElementBlock> element_blocks(const std::vector<Vector3>& rest,
                                         const std::vector<std::array<int, 4>>& tetrahedra,
                                         const std::vector<int>& elements, const FemMaterial& material) {
  std::vector<ElementBlock> blocks((elements.size() + kLanes - 1) / kLanes);
  for (size_t slot = 0; slot < blocks.size() * kLanes; ++slot) {
    const auto e = static_cast<size_t>(elements[std::min(slot, elements.size() - 1)]);
    ElementBlock& block = blocks[slot / kLanes];
    const auto lane = static_cast<Eigen::Index>(slot % kLanes);
    const std::array<int, 4>& node = block.node[slot % kLanes] = tetrahedra[e];
    Matrix3 edges;
    for (int a = 0; a < 3; ++a)
      edges.col(a) =
          rest[static_cast<size_t>(node[static_cast<size_t>(a + 1)])] - rest[static_cast<size_t>(node[0])];
    const Matrix3 inverse = edges.inverse();
    for (int a = 0; a < 3; ++a)
      for (int j = 0; j < 3; ++j)
        block.bind_gradient[static_cast<size_t>(a)][static_cast<size_t>(j)][lane] = inverse(a, j);
    const double young = material.young_pa.size() == 1 ? material.young_pa[0] : material.young_pa[e];
    const double nu = material.poisson_ratio;
    block.volume[lane] = slot < elements.size() ? edges.determinant() / 6 : 0;
    block.mu[lane] = young / (2 * (1 + nu));
    block.lambda[lane] = young * nu / ((1 + nu) * (1 - 2 * nu));
  }
  for (ElementBlock& block : blocks) {
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) block.turn[i][j].setConstant(i == j), block.offset[i][j].setZero();
    block.gradient = block.bind_gradient;
  }
  return blocks;
}

namespace {

LaneMatrix edges(const ElementBlock& block, const double* positions) {
  LaneMatrix edge;  // [i][a]
  for (size_t lane = 0; lane < kLanes; ++lane) {
    const double* x0 = positions + 3 * block.node[lane][0];
    for (size_t a = 0; a < 3; ++a) {
      const double* x = positions + 3 * block.node[lane][a + 1];
      for (size_t i = 0; i < 3; ++i) edge[i][a][static_cast<Eigen::Index>(lane)] = x[i] - x0[i];
    }
  }
  return edge;
}

// The shape has been followed to block.turn.
void stand_in(ElementBlock& block, const LaneMatrix& edges_of_shape) {
  block.gradient = product(block.bind_gradient, transposed(block.turn));
  const LaneMatrix stretched = product(edges_of_shape, block.gradient);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) block.offset[i][j] = (i == j ? 1.0 : 0.0) - stretched[i][j];
}

// r exp([w]x) for the quaternion (1, w / 2): the same direction, and by less where w is large.
LaneMatrix turned_by(const LaneMatrix& r, const std::array<Lanes, 3>& w) {
  const Lanes x = 0.5 * w[0], y = 0.5 * w[1], z = 0.5 * w[2];
  const Lanes s = 2.0 / (1.0 + x * x + y * y + z * z);
  return product(r, {{{1.0 - s * (y * y + z * z), s * (x * y - z), s * (x * z + y)},
                      {s * (x * y + z), 1.0 - s * (x * x + z * z), s * (y * z - x)},
                      {s * (x * z - y), s * (y * z + x), 1.0 - s * (x * x + y * y)}}});
}

// Newton's step from r, in its axes, towards the largest tr(r^T a): (tr(S) I - S)^-1 2 axl(S), S = r^T a;
// along the gradient where that is not concave (Mueller et al. 2016 take it everywhere).
std::array<Lanes, 3> towards_nearest(const LaneMatrix& r, const LaneMatrix& a) {
  constexpr double kConcave = 1e-3;
  const LaneMatrix s = product(transposed(r), a);
  const Lanes trace = s[0][0] + s[1][1] + s[2][2];
  const Lanes size = squared_norm(a).sqrt() + 1e-30;
  const std::array<Lanes, 3> slope = {s[2][1] - s[1][2], s[0][2] - s[2][0], s[1][0] - s[0][1]};
  LaneMatrix h;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) h[i][j] = (i == j ? trace : Lanes::Zero()) - 0.5 * (s[i][j] + s[j][i]);
  const LaneMatrix c = cofactor(h);
  const Lanes volume = determinant(h, c);
  const auto concave =
      h[0][0] > kConcave * size && c[2][2] > kConcave * size.square() && volume > kConcave * size.cube();
  std::array<Lanes, 3> w;
  for (size_t i = 0; i < 3; ++i)
    w[i] = concave.select((c[i][0] * slope[0] + c[i][1] * slope[1] + c[i][2] * slope[2]) / volume,
                          slope[i] / size);
  return w;
}

}  // namespace

LaneMatrix transposed(const LaneMatrix& r) {
  LaneMatrix t;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) t[i][j] = r[j][i];
  return t;
}

LaneStrain turned(const LaneMatrix& r, const LaneStrain& e) {
  const LaneMatrix t = product(product(r, full(e)), transposed(r));
  return {t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[2][0]};
}

void reshape(ElementBlock& block, const double* unstressed) {
  const LaneMatrix shape = edges(block, unstressed);
  block.turn = rotations(product(shape, block.bind_gradient));
  stand_in(block, shape);
}

void follow(ElementBlock& block, const double* unstressed, double most_rad) {
  constexpr int kSteps = 3;  // the first two bring what has turned by 0.1 rad to within 1e-6
  const LaneMatrix shape = edges(block, unstressed), bent = product(shape, block.bind_gradient);
  for (int step = 0; step < kSteps; ++step) {
    std::array<Lanes, 3> w = towards_nearest(block.turn, bent);
    const Lanes angle = (w[0].square() + w[1].square() + w[2].square()).sqrt();
    const Lanes share = (most_rad / kSteps) / angle.max(most_rad / kSteps);
    for (Lanes& one : w) one *= share;
    block.turn = turned_by(block.turn, w);
  }
  stand_in(block, shape);
}

LaneMatrix deformation_gradient(const ElementBlock& block, const double* positions) {
  LaneMatrix f = product(edges(block, positions), block.gradient);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) f[i][j] += block.offset[i][j];
  return f;
}

LaneStrain strain(Elasticity elasticity, const LaneMatrix& f) {
  return elasticity == Elasticity::kLinear ? small_strain(f) : green_strain(f);
}

Lanes energy_density(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f) {
  if (elasticity == Elasticity::kNeoHookean) return neo_hookean_energy(block, f);
  if (elasticity == Elasticity::kLinear) return hooke_energy(block, small_strain(f));
  return hooke_energy(block, strain_against(rotations(f), f));  // R^T F is symmetric: |F-R| = |R^T F - I|
}

LaneMatrix stress(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f) {
  if (elasticity == Elasticity::kNeoHookean) return neo_hookean_stress(block, f);
  if (elasticity == Elasticity::kLinear) return full(hooke(block, small_strain(f)));
  const LaneMatrix r = rotations(f);
  return product(r, full(hooke(block, strain_against(r, f))));
}

void add_viscous_stress(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f,
                        double viscosity, const LaneStrain& target, LaneMatrix& p) {
  LaneStrain e = strain(elasticity, f);
  for (size_t k = 0; k < 6; ++k) e[k] = viscosity * (e[k] - target[k]);
  const LaneMatrix s = full(hooke(block, e));
  const LaneMatrix added = elasticity == Elasticity::kLinear ? s : product(f, s);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) p[i][j] += added[i][j];
}

Lanes viscous_energy_density(Elasticity elasticity, const ElementBlock& block, const LaneMatrix& f,
                             double viscosity, const LaneStrain& target) {
  LaneStrain e = strain(elasticity, f);
  for (size_t k = 0; k < 6; ++k) e[k] -= target[k];
  return viscosity * hooke_energy(block, e);
}

void add_gradient(const ElementBlock& block, const LaneMatrix& p, double* gradient) {
  LaneMatrix h;  // [a][i]: V P g of corner a + 1
  for (size_t a = 0; a < 3; ++a)
    for (size_t i = 0; i < 3; ++i)
      h[a][i] = block.volume * (p[i][0] * block.gradient[a][0] + p[i][1] * block.gradient[a][1] +
                                p[i][2] * block.gradient[a][2]);
  for (size_t lane = 0; lane < kLanes; ++lane) {
    const auto l = static_cast<Eigen::Index>(lane);
    double* g0 = gradient + 3 * block.node[lane][0];
    for (size_t a = 0; a < 3; ++a) {
      double* g = gradient + 3 * block.node[lane][a + 1];
      for (size_t i = 0; i < 3; ++i) {
        g[i] += h[a][i][l];
        g0[i] -= h[a][i][l];
      }
    }
  }
}

namespace {

Eigen::Matrix<double, 9, 1> flat(const Matrix3& a) {
  return Eigen::Map<const Eigen::Matrix<double, 9, 1>>(a.data());
}

// dP for each unit dF, column by column of the 9x9.
template <typename Directional>
Matrix9 by_columns(const Directional& directional) {
  Matrix9 d;
  for (int k = 0; k < 9; ++k) {
    Matrix3 unit = Matrix3::Zero();
    unit(k % 3, k / 3) = 1;
    d.col(k) = flat(directional(unit));
  }
  return d;
}

Matrix3 hooke(double mu, double lambda, const Matrix3& e) {
  return mu * (e + e.transpose()) + lambda * e.trace() * Matrix3::Identity();
}

Matrix3 hat(const Vector3& w) {
  Matrix3 m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

Matrix9 neo_hookean_derivative(double lame_mu, double lame_lambda, const Matrix3& f) {
  const StableNeoHookean<double> m(lame_mu, lame_lambda);
  Matrix3 c;
  c << f.col(1).cross(f.col(2)), f.col(2).cross(f.col(0)), f.col(0).cross(f.col(1));
  const double stretch = f.squaredNorm() + 1, pressure = m.lambda * (f.determinant() - m.rest_volume);
  Matrix9 d = m.mu * (1 - 1 / stretch) * Matrix9::Identity();
  d += 2 * m.mu / (stretch * stretch) * flat(f) * flat(f).transpose() +
       m.lambda * flat(c) * flat(c).transpose();
  for (int a = 0; a < 3;
       ++a) {  // second derivative of J: column a by column b is the cross product with the third
    const int b = (a + 1) % 3;
    const Matrix3 cross = pressure * hat(f.col((a + 2) % 3));
    d.block<3, 3>(3 * a, 3 * b) -= cross;
    d.block<3, 3>(3 * b, 3 * a) += cross;
  }
  return d;
}

// dR = R hat((tr(S) I - S)^-1 2 axl(skew(R^T dF))), S = R^T F.
Matrix9 corotational_derivative(double mu, double lambda, const Matrix3& f) {
  const Matrix3 r = nearest_rotation(f), s = r.transpose() * f;
  const Matrix3 solve = (s.trace() * Matrix3::Identity() - s).inverse();
  const Matrix3 law = hooke(mu, lambda, s - Matrix3::Identity());
  return by_columns([&](const Matrix3& df) -> Matrix3 {
    const Matrix3 w = r.transpose() * df;
    const Matrix3 spin = hat(solve * Vector3(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1)));
    return r * (spin * law + hooke(mu, lambda, w - spin * s));
  });
}

Matrix9 stress_derivative(Elasticity elasticity, double mu, double lambda, const Matrix3& f) {
  if (elasticity == Elasticity::kNeoHookean) return neo_hookean_derivative(mu, lambda, f);
  if (elasticity == Elasticity::kCorotational) return corotational_derivative(mu, lambda, f);
  return by_columns([&](const Matrix3& df) { return hooke(mu, lambda, df); });
}

Matrix9 viscous_derivative(Elasticity elasticity, double mu, double lambda, const Matrix3& f,
                           const Matrix3& excess) {
  if (elasticity == Elasticity::kLinear)
    return by_columns([&](const Matrix3& df) { return hooke(mu, lambda, df); });
  const Matrix3 s = hooke(mu, lambda, excess);
  return by_columns([&](const Matrix3& df) -> Matrix3 {
    const Matrix3 rate = 0.5 * (df.transpose() * f + f.transpose() * df);
    return df * s + f * hooke(mu, lambda, rate);
  });
}

void cut_negative_eigenvalues(Matrix9& d) {
  const Eigen::SelfAdjointEigenSolver<Matrix9> eigen(d);
  if (eigen.eigenvalues()[0] >= 0) return;
  d = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

Matrix3 strain_excess(Elasticity elasticity, int lane, const LaneMatrix& f, const LaneStrain& target) {
  LaneStrain e = strain(elasticity, f);
  for (size_t k = 0; k < 6; ++k) e[k] -= target[k];
  return lane_of(full(e), lane);
}

}  // namespace

ElementStiffness element_stiffness(Elasticity elasticity, const ElementBlock& block, int lane,
                                   const LaneMatrix& f, double viscosity, const LaneStrain* target,
                                   bool project) {
  const Matrix3 one = lane_of(f, lane);
  Matrix9 d = stress_derivative(elasticity, block.mu[lane], block.lambda[lane], one);
  if (viscosity > 0 && target)
    d += viscosity * viscous_derivative(elasticity, block.mu[lane], block.lambda[lane], one,
                                        strain_excess(elasticity, lane, f, *target));
  if (project) cut_negative_eigenvalues(d);
  const Matrix3 inner = lane_of(block.gradient, lane);
  Eigen::Matrix<double, 9, 12> b = Eigen::Matrix<double, 9, 12>::Zero();  // vec(F) = b x
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      b(3 * j + i, i) = -inner.col(j).sum();
      for (int a = 0; a < 3; ++a) b(3 * j + i, 3 * (a + 1) + i) = inner(a, j);
    }
  return block.volume[lane] * b.transpose() * d * b;
}

}  // namespace sinew::baker
