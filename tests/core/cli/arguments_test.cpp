#include "cli/arguments.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace vitruvian {
namespace {

RegisterArguments registering(std::vector<std::string> options) {
  options.insert(options.begin(), {"register", "a.ply", "--out", "o"});
  return std::get<RegisterArguments>(parse_arguments(options));
}

std::string refusal(std::vector<std::string> options) {
  options.insert(options.begin(), {"register", "a.ply", "--out", "o"});
  try {
    parse_arguments(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "";
}

TEST(Arguments, DefaultsAreTheSettings) {
  const RegisterArguments a = registering({});
  EXPECT_EQ(a.scans, std::vector<std::string>{"a.ply"});
  EXPECT_EQ(a.out, "o");
  EXPECT_EQ(a.settings.method, Method::ours);
  EXPECT_EQ(a.settings.views, 8);
  EXPECT_EQ(a.settings.seed, 1u);
  EXPECT_EQ(a.settings.betas, 0);
  EXPECT_EQ(a.format, MeshFormat::ply);
  EXPECT_FALSE(a.quiet || a.json);
}

TEST(Arguments, EverySettingIsTaken) {
  const RegisterArguments a = registering(
      {"b.obj",    "--align",   "pca",       "--views", "2",        "--min-visibility", "0.25",
       "--init",   "keypoints", "--solver",  "fast",    "--gender", "female",           "--betas",
       "10",       "--units",   "mm",        "--up",    "-z",       "--front",          "x",
       "--detail", "off",       "--threads", "3",       "--seed",   "4294967295",       "--format",
       "glb",      "--quiet",   "--json",    "--model", "m.vbm",    "--method",         "ours"});
  EXPECT_EQ(a.scans, (std::vector<std::string>{"a.ply", "b.obj"}));
  EXPECT_EQ(a.settings.align, AlignMode::pca);
  EXPECT_EQ(a.settings.views, 2);
  EXPECT_EQ(a.settings.min_visibility, 0.25);
  EXPECT_EQ(a.settings.init, InitMode::keypoints);
  EXPECT_EQ(a.settings.gender, Gender::female);
  EXPECT_EQ(a.settings.betas, 10);
  EXPECT_EQ(a.settings.unit, Unit::millimetre);
  EXPECT_EQ(a.settings.up, Axis::minus_z);
  EXPECT_EQ(a.settings.front, Axis::x);
  EXPECT_EQ(a.settings.threads, 3);
  EXPECT_EQ(a.settings.seed, 4294967295u);
  EXPECT_EQ(a.format, MeshFormat::glb);
  EXPECT_EQ(a.model_file, "m.vbm");
  EXPECT_TRUE(a.quiet && a.json);
}

TEST(Arguments, NegativeAxesMayStandAfterEqualsToo) {
  EXPECT_EQ(registering({"--up=-y"}).settings.up, Axis::minus_y);
  EXPECT_EQ(registering({"--front", "-x"}).settings.front, Axis::minus_x);
}

TEST(Arguments, WrongValuesAreRefusedByName) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--up", "w"},        {"--views", "3"},    {"--min-visibility", "1.5"},
      {"--gender", "x"},    {"--betas", "0"},    {"--betas", "ten"},
      {"--units", "feet"},  {"--threads", "-1"}, {"--format", "stl"},
      {"--seed", "-1"},     {"--seed", "x"},     {"--align", "PCA"},
      {"--iterations", "0"}};
  for (const auto& options : wrong)
    EXPECT_NE(refusal(options).find(options[0]), std::string::npos) << options[0];
  EXPECT_NE(refusal({"--nonsense"}).find("--nonsense"), std::string::npos);
  EXPECT_NE(refusal({"--seed"}).find("--seed"), std::string::npos) << "value missing";
  EXPECT_NE(refusal({"--seed", "1", "--seed", "2"}), "") << "given twice";
  EXPECT_NE(refusal({"--up", "w"}).find("vitruvian help register"), std::string::npos);
}

TEST(Arguments, OptionsThatAProjectHoldsAreRemembered) {
  EXPECT_TRUE(registering({"--threads", "2", "--format", "obj", "--project", "p"}).decided.empty());
  EXPECT_EQ(registering({"--project", "p", "--seed", "2", "--views", "8"}).decided,
            (std::vector<std::string>{"--views", "--seed"}));
}

TEST(Arguments, FilesOfEditsAreNamed) {
  const RegisterArguments a = registering({"--init", "old.json", "--keypoints", "k.json", "--align-file",
                                           "a.json", "--crop", "c.json", "--project", "p.json"});
  EXPECT_EQ(a.init_file, "old.json");
  EXPECT_EQ(a.keypoints_file, "k.json");
  EXPECT_EQ(a.align_file, "a.json");
  EXPECT_EQ(a.crop_file, "c.json");
  EXPECT_EQ(a.project_file, "p.json");
  EXPECT_EQ(registering({"--init", "tpose"}).settings.init, InitMode::tpose);
  EXPECT_EQ(registering({"--init", "tpose"}).init_file, "");
  EXPECT_EQ(registering({"--init", "file"}).init_file, "file") << "a file of that name";
}

TEST(Arguments, MethodsStandForTheirStages) {
  const Settings paper = registering({"--method", "paper"}).settings;
  EXPECT_EQ(paper.align, AlignMode::pca);
  EXPECT_EQ(paper.views, 2);
  EXPECT_EQ(paper.init, InitMode::keypoints);
  EXPECT_EQ(paper.solver, SolverKind::paper);
  EXPECT_EQ(paper.iterations, 6000);
  EXPECT_EQ(paper.adam_iterations, 6000);
  EXPECT_FALSE(paper.one_directional);
  EXPECT_EQ(paper.chunk, 0);
  EXPECT_EQ(paper.min_visibility, 0.25);
  const Settings cpu = registering({"--method", "paper-cpu"}).settings;
  EXPECT_EQ(cpu.iterations, 2000);
  EXPECT_EQ(cpu.adam_iterations, 100);
  EXPECT_TRUE(cpu.one_directional);
  EXPECT_EQ(cpu.align, AlignMode::pca);
}

TEST(Arguments, SingleStagesOverrideTheMethodWhereverTheyStand) {
  const Settings s = registering({"--views", "8", "--init", "tpose", "--method", "paper-cpu", "--align",
                                  "auto", "--iterations", "50", "--chunk", "512", "--one-directional=false"})
                         .settings;
  EXPECT_EQ(s.views, 8);
  EXPECT_EQ(s.init, InitMode::tpose);
  EXPECT_EQ(s.align, AlignMode::automatic);
  EXPECT_EQ(s.solver, SolverKind::paper);
  EXPECT_EQ(s.iterations, 50);
  EXPECT_EQ(s.adam_iterations, 100);
  EXPECT_EQ(s.chunk, 512);
  EXPECT_FALSE(s.one_directional);
  EXPECT_EQ(registering({"--method", "paper", "--solver", "fast"}).settings.solver, SolverKind::fast);
  const Settings solver = registering({"--solver", "paper", "--adam-iterations", "0"}).settings;
  EXPECT_EQ(solver.align, AlignMode::automatic);
  EXPECT_EQ(solver.iterations, 6000);
  EXPECT_EQ(solver.adam_iterations, 0);
}

TEST(Arguments, IterationsBelongToThePaperSolver) {
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--iterations", "5"},
                                             {"--adam-iterations", "5"},
                                             {"--one-directional"},
                                             {"--chunk", "5"},
                                             {"--method", "paper", "--solver", "fast", "--chunk", "5"}}) {
    EXPECT_NE(refusal(options).find("--solver paper"), std::string::npos) << options[0];
  }
}

TEST(Arguments, OtherCommands) {
  const auto evaluate =
      std::get<EvaluateArguments>(parse_arguments({"evaluate", "r.json", "--truth", "t.json"}));
  EXPECT_EQ(evaluate.registration_file, "r.json");
  EXPECT_EQ(evaluate.truth_file, "t.json");
  EXPECT_EQ(std::get<ModelInfoArguments>(parse_arguments({"model", "info", "b.vbm"})).file, "b.vbm");
  EXPECT_TRUE(std::holds_alternative<MeasureArguments>(
      parse_arguments({"measure", "r.json", "--out", "o", "--section", "left_arm:t=0.5", "--section",
                       "left_leg:d=10@distal", "--profile", "hips:5", "--model", "m", "--scan", "s"})));
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{},
                                             {"evaluate", "r.json"},
                                             {"model"},
                                             {"model", "info"},
                                             {"nonsense"},
                                             {"register", "--out", "o"},
                                             {"register", "a.ply"},
                                             {"help", "nonsense"},
                                             {"measure"}}) {
    EXPECT_THROW(parse_arguments(wrong), Error) << (wrong.empty() ? "nothing" : wrong[0]);
  }
}

TEST(Arguments, HelpListsEveryOptionOfTheContract) {
  const std::string help = std::get<PrintArguments>(parse_arguments({"help", "register"})).text;
  for (const char* option : {"--out",
                             "--method",
                             "ours|paper|paper-cpu",
                             "--align",
                             "auto|pca",
                             "--views",
                             "2|8",
                             "--min-visibility",
                             "--init",
                             "auto|keypoints|tpose|FILE",
                             "--solver",
                             "fast|paper",
                             "--iterations",
                             "--adam-iterations",
                             "--one-directional",
                             "--chunk",
                             "--model",
                             "--gender",
                             "neutral|female|male",
                             "--betas",
                             "--dmpl",
                             "--prior",
                             "--units",
                             "auto|m|cm|mm|in",
                             "--up",
                             "auto|x|y|z|-x|-y|-z",
                             "--front",
                             "--align-file",
                             "--keypoints",
                             "--regions",
                             "--crop",
                             "--project",
                             "--detail",
                             "off|vertex",
                             "--threads",
                             "--seed",
                             "--format",
                             "ply|obj|glb",
                             "--quiet",
                             "--json"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option << "\n" << help;
  }
  EXPECT_EQ(std::get<PrintArguments>(parse_arguments({"register", "--help"})).text, help);
  const std::string all = std::get<PrintArguments>(parse_arguments({"--help"})).text;
  for (const char* command : {"register", "measure", "evaluate", "model", "help", "--version"}) {
    EXPECT_NE(all.find(command), std::string::npos) << command << "\n" << all;
  }
  EXPECT_EQ(std::get<PrintArguments>(parse_arguments({"help"})).text, all);
  const std::string measure = std::get<PrintArguments>(parse_arguments({"help", "measure"})).text;
  for (const char* option : {"--out", "--model", "--scan", "--section", "--profile"}) {
    EXPECT_NE(measure.find(option), std::string::npos) << option;
  }
}

TEST(Arguments, Version) {
  EXPECT_EQ(std::get<PrintArguments>(parse_arguments({"--version"})).text,
            std::string("vitruvian ") + VITRUVIAN_VERSION + "\n");
}

}  // namespace
}  // namespace vitruvian
