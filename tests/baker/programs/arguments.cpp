// arguments.cpp  Every command refuses unusable arguments with one line and exit code 2.
#include <cstdlib>

#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/bake.hpp"

using namespace sinew::test;

TEST_CASE("commands_and_options_that_do_not_exist_are_refused") {
  check_refused({}, {"subcommand is required"});
  check_refused({"bakery"}, {"no command 'bakery'"});
  check_refused({"info"}, {"file is required"});
  check_refused({"info", "a", "--xml"}, {"--xml"});
  check_refused({"model", "w.safetensors"}, {"--output"});
  check_refused({"check", "m.sinew"}, {"vectors"});
  check_refused({"check", "m", "v", "--tolerance", "small"}, {"--tolerance"});
  check_refused({"check", "m", "v", "--tolerance", "-1"}, {"--tolerance"});
  check_refused({"check", "m", "v", "--precision", "fp64"}, {"--precision fp64", "fp32, fp16, int8"});
  check_refused({"model", "w", "-o", "m", "--calibrate", "v"}, {"--calibrate", "int8"});
  check_refused({"check", "m", "v", "--isa", "abacus"}, {"--isa abacus", "abacus"});
  check_refused({"model", "w", "-o", "m", "--precision", "int4"}, {"--precision int4", "fp32, fp16, int8"});
  check_refused({"character", "c.glb", "-o", "c", "--precision", "int8"}, {"--precision"});
  check_refused({"judge", "c.sinew"}, {"--truth"});
  check_refused({"judge", "--truth", "t"}, {"characters"});
  check_refused({"judge", "c.sinew", "--truth", "t", "--ticks", "0"}, {"--ticks", "1 to 1000000"});
  check_refused({"judge", "c.sinew", "--truth", "t", "--most-added", "-1"}, {"--most-added"});
  check_refused({"judge", "c.sinew", "--truth", "t", "--isa", "abacus"}, {"--isa abacus"});
  check_refused({"creature", "r.json", "-o", "c.glb", "--vertices", "199"},
                {"--vertices 199", "200 to 50000"});
  check_refused({"creature", "r.json", "-o", "c.glb", "--vertices", "50001"}, {"--vertices 50001"});
  check_refused({"creature", "r.json", "-o", "c.glb", "--vertices", "-3"}, {"--vertices"});
}

TEST_CASE("check_refuses_an_instruction_set_in_the_environment_that_is_not_there") {
  setenv("SINEW_ISA", "abacus", 1);
  check_refused({"check", "m", "v"}, {"SINEW_ISA", "abacus", "use one"});
  unsetenv("SINEW_ISA");
}

TEST_CASE("paths_that_do_not_exist_are_named") {
  const TemporaryFolder folder;
  const std::string missing = folder.file("missing"), output = folder.file("out");
  check_refused({"info", missing}, {missing, "No such file"});
  check_refused({"info", missing + ".sinew"}, {missing + ".sinew", "No such file"});
  check_refused({"info", folder.path()}, {folder.path()});
  check_refused({"model", missing, "-o", output}, {missing, "No such file"});
  check_refused({"check", missing, missing}, {missing, "No such file"});
  check_refused({"judge", missing, "--truth", missing}, {missing, "No such file"});
  check_refused({"creature", missing, "-o", output}, {missing});
  check_refused({"character", missing, "--tissue", missing, "-o", output}, {missing});
  check_refused({"character", missing, "--recipe", missing, "--tissue", missing, "-o", output}, {missing});
  CHECK(folder.entries() == 0);
}

TEST_CASE("a_directory_in_the_place_of_a_file_is_named_before_any_work") {
  const TemporaryFolder folder;
  const std::string missing = folder.file("missing");
  check_refused({"character", missing, "-o", folder.path()},
                {folder.path(), "directory", "name a file in it"});
  check_refused({"truth", missing, "--motion", "shake", "-o", folder.path()},
                {"directory", "name a file in it"});
  check_refused({"character", folder.path(), "-o", missing}, {folder.path(), "directory"});
  check_refused({"character", missing, "--recipe", folder.path(), "-o", missing},
                {folder.path(), "directory"});
}

TEST_CASE("help_goes_to_stdout_and_names_every_command") {
  const ProgramResult help = bake({"--help"});
  CHECK(help.exit_code == 0);
  CHECK(help.error.empty());
  for (const char* command : {"audit", "creature", "character", "model", "check", "info", "judge", "truth"})
    CHECK_THAT(help.out, Catch::Contains(command));
}
