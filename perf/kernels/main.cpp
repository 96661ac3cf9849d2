// main.cpp  All benches in one process, on one thread.
#include <benchmark/benchmark.h>
#ifdef _OPENMP
#include <omp.h>
#endif

int main(int argc, char** argv) {
#ifdef _OPENMP
  omp_set_num_threads(1);  // oneDNN's
#endif
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
