// test_main.cpp  Runs the tests; where all went well, and one has said "skipped: ..." by a WARN, exits with
// 77, which ctest shows as skipped.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

namespace {

bool was_skipped = false;

struct SeesSkipped : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;
  bool assertionEnded(const Catch::AssertionStats& stats) override {
    if (stats.assertionResult.getResultType() == Catch::ResultWas::Warning)
      was_skipped |= stats.infoMessages.back().message.rfind("skipped: ", 0) == 0;
    return true;
  }
};

}  // namespace

CATCH_REGISTER_LISTENER(SeesSkipped)

int main(int count, char** arguments) {
  const int result = Catch::Session().run(count, arguments);
  if (result == 0 && was_skipped) return 77;
  return result == 77 ? 1 : result;
}
