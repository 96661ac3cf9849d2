// test_mlp.cpp  Chains of dense layers against plain double loops, for every way to read and to write a row.
#include <limits>

#include "tests/simd/chain.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;
using simd::Pointwise;

namespace {

// Sums of up to 192 terms of order 1/8, four layers deep: measured 4.0e-6, room for another seed.
constexpr double kChain = 1e-5;
constexpr float kUntouched = 55;

// Rows in one part, read as they lie.
struct Job {
  Job(std::mt19937& random, const std::vector<uint32_t>& widths, uint32_t rows, Pointwise function)
      : rows(rows),
        width(widths.front()),
        stride(width + 3),
        chain(test::random_chain(random, widths)),
        packed({chain}),
        planes(test::random_rows(random, 3 * kPlaneRows, width, stride, 1)),
        padded(packed.layers().back().padded),
        out(kPlaneRows * padded, kUntouched),
        scratch(simd::mlp_floats(widest_of(packed)), kStale) {
    job.widest = widest_of(packed);
    job.layers = packed.layers().data();
    job.weights = packed.weights();
    job.layer_count = static_cast<uint32_t>(chain.size());
    job.parts[job.part_count++] = {planes.data(), stride, width, nullptr};
    job.between = function;
    job.out = out.data();
    job.out_stride = padded;
    job.scratch = scratch.data();
  }
  static uint32_t widest_of(const test::PackedChains& chains) {
    uint32_t widest = 0;
    for (const pack::DenseRecord& layer : chains.layers()) widest = std::max(widest, layer.padded);
    return widest;
  }
  std::vector<double> plain_row(uint32_t i) {
    const float* row = &planes[i * stride];
    return test::plain_mlp(chain, job.between, job.last, {row, row + width});
  }
  // Largest difference from the plain result; what lies behind the rows must be untouched.
  double difference() {
    double worst = 0;
    for (uint32_t i = 0; i < rows; ++i) {
      const std::vector<double> want = plain_row(i);
      for (size_t j = 0; j < want.size(); ++j) {
        const double off = std::fabs(out[i * padded + j] - want[j]);
        worst = test::larger(worst, off);
      }
      for (size_t j = want.size(); j < padded; ++j) REQUIRE(out[i * padded + j] == 0);
    }
    for (size_t i = rows * padded; i < out.size(); ++i) REQUIRE(out[i] == kUntouched);
    return worst;
  }

  static constexpr uint32_t kPlaneRows = 2 * simd::kRangeNodes + 20;
  static constexpr float kStale = 1e30f;  // what an earlier call may have left in the scratch
  uint32_t rows, width;
  size_t stride;
  test::PlainChain chain;
  test::PackedChains packed;
  test::Floats planes;
  size_t padded;
  test::Floats out, scratch;
  simd::MlpJob job;
};

// Two parts through indices, a start, a scale, added to rows of another order: what a network of graphs
// needs.
struct GatheredJob : Job {
  explicit GatheredJob(std::mt19937& random, uint32_t rows)
      : Job(random, {70, 33, 130}, rows, Pointwise::kRelu),
        starts(test::random_rows(random, 10, 33, 48, 1)),
        scale(test::random_rows(random, 1, 130, 144, 1)) {
    for (uint32_t i = 0; i < rows; ++i) {
      first.push_back((i * 7 + 3) % kPlaneRows);
      second.push_back(i % 5);
      start.push_back(i % 10);
      to.push_back((rows - 1 - i) / 2);
    }
    // Inputs 6 .. 69; 0 .. 5 are met by the start.
    job.first_input = 6;
    job.parts[0] = {planes.data(), stride, 50, first.data()};
    job.parts[1] = {planes.data() + kPlaneRows * stride, stride, 10, second.data()};
    job.parts[2] = {planes.data() + 2 * kPlaneRows * stride, stride, 4, nullptr};
    job.part_count = 3;
    job.start = {starts.data(), 48, 0, start.data()};
    job.scale = scale.data();
    job.last = Pointwise::kTanh;
    job.adds = true;
    job.out_index = to.data();
  }
  // Row i's z W_1 with its start in the place of bias and of the inputs before first_input.
  std::vector<double> plain_first(uint32_t i) {
    const float* parts[] = {&planes[first[i] * stride], &planes[(kPlaneRows + second[i]) * stride],
                            &planes[(2 * kPlaneRows + i) * stride]};
    std::vector<double> x(6);
    x.insert(x.end(), parts[0], parts[0] + 50);
    x.insert(x.end(), parts[1], parts[1] + 10);
    x.insert(x.end(), parts[2], parts[2] + 4);
    std::vector<double> z = test::plain_dense(chain[0], x);
    for (size_t j = 0; j < z.size(); ++j) z[j] += double{starts[start[i] * 48 + j]} - double{chain[0].b[j]};
    return z;
  }
  std::vector<double> plain_out() {
    std::vector<double> sum(out.size(), kUntouched);
    for (uint32_t i = 0; i < rows; ++i) {
      std::vector<double> z = plain_first(i);
      for (double& value : z) value = test::pointwise(job.between, value);
      const std::vector<double> last = test::plain_dense(chain[1], z);
      for (size_t j = 0; j < last.size(); ++j)
        sum[to[i] * padded + j] += std::tanh(last[j]) * double{scale[j]};
    }
    return sum;
  }
  test::Floats starts, scale;
  std::vector<uint32_t> first, second, start, to;
};

}  // namespace

TEST_CASE("mlp_is_the_chain_for_every_function_and_depth") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const Pointwise function : {Pointwise::kNone, Pointwise::kRelu, Pointwise::kTanh}) {
      for (const auto& widths : std::vector<std::vector<uint32_t>>{
               {37, 128, 128, 128, 128}, {18, 64, 3}, {192, 192, 192, 3}, {5, 6}, {14, 8, 8, 8}}) {
        std::mt19937 random(4);
        Job job(random, widths, 13, function);
        kernels.mlp(job.job, 0, 13);
        CHECK(job.difference() <= kChain);
      }
    }
  });
}

TEST_CASE("mlp_is_the_chain_for_partial_tiles_ranges_and_panels") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t rows : {1u, 2u, 5u, 6u, 7u, simd::kRangeNodes, simd::kRangeNodes + 1, 100u}) {
      for (const uint32_t width : {1u, 15u, 16u, 17u, 48u, 64u, 65u, 100u, 130u}) {
        std::mt19937 random(width);
        Job job(random, {width, width, width}, rows, Pointwise::kTanh);
        kernels.mlp(job.job, 0, rows);
        CHECK(job.difference() <= kChain);
      }
    }
  });
}

TEST_CASE("mlp_reads_its_parts_and_its_start_through_indices_and_adds_to_the_rows_it_is_told") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const uint32_t rows : {1u, 7u, simd::kRangeNodes + 5}) {
      std::mt19937 random(rows);
      GatheredJob job(random, rows);
      kernels.mlp(job.job, 0, rows);
      const std::vector<double> want = job.plain_out();
      double worst = 0;
      for (size_t i = 0; i < want.size(); ++i) worst = test::larger(worst, std::fabs(job.out[i] - want[i]));
      CHECK(worst <= kChain);
    }
  });
}

TEST_CASE("mlp_may_add_to_the_rows_it_reads") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    std::mt19937 random(5);
    Job job(random, {80, 80, 80}, 2 * simd::kRangeNodes + 3, Pointwise::kRelu);
    test::Floats apart = test::random_rows(random, job.rows, 80, 80, 1), both(apart.size()),
                 out(apart.size());
    std::copy_n(apart.data(), apart.size(), both.data());
    job.job.adds = true;
    job.job.parts[0] = {both.data(), 80, 80, nullptr};
    job.job.out = both.data();
    kernels.mlp(job.job, 0, job.rows);
    job.job.parts[0].rows = apart.data();
    std::copy_n(apart.data(), apart.size(), out.data());
    job.job.out = out.data();
    kernels.mlp(job.job, 0, job.rows);
    REQUIRE(both.copy() == out.copy());
  });
}

TEST_CASE("mlp_gives_the_same_bits_wherever_its_rows_are_cut") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    constexpr uint32_t kRows = simd::kRangeNodes + 9;
    std::vector<float> whole;
    for (uint32_t cut = 0; cut <= kRows; ++cut) {
      std::mt19937 random(6);
      GatheredJob job(random, kRows);
      kernels.mlp(job.job, 0, cut);
      kernels.mlp(job.job, cut, kRows);
      if (cut == 0) whole = job.out.copy();
      REQUIRE(job.out.copy() == whole);
    }
  });
}

TEST_CASE("nan_in_a_row_reaches_its_output_through_every_function_and_no_other_row") {
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    for (const Pointwise function : {Pointwise::kNone, Pointwise::kRelu, Pointwise::kTanh}) {
      for (const float nan :
           {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN()}) {
        std::mt19937 random(7);
        Job job(random, {20, 40, 40, 3}, 9, function);
        job.planes[4 * job.stride] = nan;
        kernels.mlp(job.job, 0, 9);
        for (uint32_t i = 0; i < 9; ++i) REQUIRE(std::isnan(job.out[i * job.padded]) == (i == 4));
      }
    }
  });
}

TEST_CASE("mlp_has_the_same_bits_on_all_targets_with_fma") {
  test::require_same_bits_where_fused(0x19e4b5480dbcf6e8, [&](const simd::Kernels& kernels) {
    std::mt19937 random(8);
    Job tanh(random, {37, 128, 80, 3}, 20, Pointwise::kTanh);
    kernels.mlp(tanh.job, 0, 20);
    GatheredJob relu(random, 60);
    kernels.mlp(relu.job, 0, 60);
    std::vector<float> values = tanh.out.copy();
    const std::vector<float> more = relu.out.copy();
    values.insert(values.end(), more.begin(), more.end());
    return values;
  });
}
