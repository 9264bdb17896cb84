#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/error.h"
#include "pipeline/settings_names.h"

namespace vitruvian {
namespace {

/// What a project file holds.
constexpr const char* kInProject[] = {"--method",
                                      "--align",
                                      "--views",
                                      "--min-visibility",
                                      "--init",
                                      "--solver",
                                      "--iterations",
                                      "--adam-iterations",
                                      "--one-directional",
                                      "--chunk",
                                      "--gender",
                                      "--betas",
                                      "--units",
                                      "--up",
                                      "--front",
                                      "--align-file",
                                      "--keypoints",
                                      "--regions",
                                      "--crop",
                                      "--detail",
                                      "--seed"};

/// Adds an option whose values are the names of an enumeration.
template <typename Enum>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Enum& target, const std::string& help) {
  std::vector<std::string> names;
  std::string shown;
  for (const NamedValue<Enum>& value : named_values<Enum>()) {
    names.emplace_back(value.name);
    shown += (shown.empty() ? "" : "|") + names.back();
  }
  return command
      .add_option_function<std::string>(
          name, [&target](const std::string& text) { target = *value_named<Enum>(text); }, help)
      ->check(CLI::IsMember(names).description(""))
      ->type_name(shown);
}

/// Options that exist in the contract before their feature does.
struct Pending {
  std::vector<std::string> texts;
  std::string init;
};

void add_method_options(CLI::App& command, RegisterArguments& a, Pending& pending) {
  command.option_defaults()->group("Method");
  add_choice(command, "--method", a.settings.method,
             "ours, or every stage as published (paper), or as published with its CPU settings (paper-cpu)");
  add_choice(command, "--align", a.settings.align,
             "how up and front are found: by looking, or by PCA as published");
  command.add_option("--views", a.settings.views, "number of pictures: 2 as published, or 8")
      ->check(CLI::IsMember({2, 8}).description(""))
      ->type_name("2|8");
  command
      .add_option("--min-visibility", a.settings.min_visibility,
                  "landmarks seen less surely are not used, 0 to 1 (default: 0, as published 0.25)")
      ->check(CLI::Range(0.0, 1.0).description(""))
      ->type_name("F");
  command.add_option("--init", pending.init, "start of the fit; FILE is an earlier registration.json")
      ->type_name("auto|keypoints|tpose|FILE");
  add_choice(command, "--solver", a.settings.solver, "optimiser of the fit");
  const auto add_count = [&](const char* name, int& target, int least, const char* help) {
    command.add_option(name, target, help)->check(CLI::Range(least, 1000000).description(""))->type_name("N");
  };
  add_count("--iterations", a.settings.iterations, 1,
            "iterations of each stage (paper solver; default: 6000, paper-cpu 2000)");
  add_count("--adam-iterations", a.settings.adam_iterations, 0,
            "of these by Adam, the rest by L-BFGS (paper solver; default: 6000, paper-cpu 100)");
  command.add_flag("--one-directional", a.settings.one_directional,
                   "distances from template to scan only (paper solver)");
  add_count("--chunk", a.settings.chunk, 1,
            "distances by brute force, N x N at once, instead of by kd-trees (paper solver)");
}

void add_model_options(CLI::App& command, RegisterArguments& a) {
  command.option_defaults()->group("Body model");
  command
      .add_option("--model", a.model_file,
                  "body model: SMPL, SMPL+H, SMPL-X or STAR, .pkl or .npz (default: the bundled body)")
      ->type_name("FILE");
  add_choice(command, "--gender", a.settings.gender, "which population the shape is expected from");
  command
      .add_option("--betas", a.settings.betas,
                  "number of shape components (default: all, of --model at most 16)")
      ->check(CLI::Range(1, 10000).description(""))
      ->type_name("N");
  command.add_option("--dmpl", a.dmpl_file, "soft-tissue model (DMPL .npz) for SMPL or SMPL+H")
      ->type_name("FILE");
  command
      .add_option("--prior", a.prior_file,
                  "pose prior: a VPoser v2 checkpoint in place of the bundled autoencoder, or a .vpp file")
      ->type_name("FILE");
}

void add_scan_options(CLI::App& command, RegisterArguments& a) {
  command.option_defaults()->group("How the scan lies");
  add_choice(command, "--units", a.settings.unit, "unit of the file");
  add_choice(command, "--up", a.settings.up, "axis of the file that points up");
  add_choice(command, "--front", a.settings.front, "axis of the file that the body faces");
  command.add_option("--align-file", a.align_file, "4x4 body_from_scan as JSON")->type_name("FILE");
  command.option_defaults()->group("Edits made by hand");
  command.add_option("--keypoints", a.keypoints_file, "joints placed by hand, used instead of looking")
      ->type_name("FILE");
  command.add_option("--regions", a.regions_file, "pairs of regions that belong together")->type_name("FILE");
  command.add_option("--crop", a.crop_file, "what to cut away from the scan, boxes and lassos")
      ->type_name("FILE");
  command
      .add_option("--project", a.project_file,
                  "settings and edits in one file, as the page saves it; replaces the options above")
      ->type_name("FILE");
}

void add_output_options(CLI::App& command, RegisterArguments& a) {
  command.option_defaults()->group("Output");
  command.add_option("--out", a.out, "results go to DIR/NAME/ for each scan NAME")
      ->required()
      ->type_name("DIR");
  command
      .add_option_function<std::string>(
          "--format",
          [&a](const std::string& text) {
            a.format = text == "obj" ? MeshFormat::obj : text == "glb" ? MeshFormat::glb : MeshFormat::ply;
          },
          "file format of the registered mesh")
      ->check(CLI::IsMember({"ply", "obj", "glb"}).description(""))
      ->type_name("ply|obj|glb");
  add_choice(command, "--detail", a.settings.detail, "free-form refinement of each vertex after the fit");
  command.add_option("--threads", a.settings.threads, "threads to use (default: all of the machine's)")
      ->check(CLI::Range(1, 256).description(""))
      ->type_name("N");
  command.add_option("--seed", a.settings.seed, "seed of all random choices (default: 1)")->type_name("N");
  command.add_flag("--quiet", a.quiet, "no progress, no report");
  command.add_flag("--json", a.json, "one line of JSON on stdout for each scan");
}

void settle_register(const CLI::App& command, const Pending& pending, RegisterArguments& a) {
  for (const char* name : kInProject) {
    if (command.count(name) > 0) a.decided.emplace_back(name);
  }
  // The method's stages, but for those that were given.
  const Settings method = settings_of(a.settings.method);
  const auto stage = [&](const char* option, auto Settings::*member) {
    if (command.count(option) == 0) a.settings.*member = method.*member;
  };
  stage("--align", &Settings::align);
  stage("--views", &Settings::views);
  stage("--min-visibility", &Settings::min_visibility);
  stage("--init", &Settings::init);
  stage("--solver", &Settings::solver);
  stage("--iterations", &Settings::iterations);
  stage("--adam-iterations", &Settings::adam_iterations);
  stage("--one-directional", &Settings::one_directional);
  if (a.settings.solver != SolverKind::paper) {
    for (const char* name : {"--iterations", "--adam-iterations", "--one-directional", "--chunk"}) {
      if (command.count(name) > 0)
        throw Error(ErrorCode::usage,
                    std::string(name) + " belongs to --solver paper: add that, or --method paper");
    }
  }
  if (pending.init.empty()) return;
  const std::optional<InitMode> init = value_named<InitMode>(pending.init);
  if (init && *init != InitMode::file) {
    a.settings.init = *init;
  } else {
    a.init_file = pending.init;
  }
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

std::string registered_mesh_name(MeshFormat format) {
  switch (format) {
    case MeshFormat::ply:
      return "registered.ply";
    case MeshFormat::obj:
      return "registered.obj";
    case MeshFormat::glb:
      return "registered.glb";
  }
  throw Error(ErrorCode::internal, "unknown mesh format");
}

Arguments parse_arguments(const std::vector<std::string>& arguments) {
  CLI::App app("Vitruvian registers a parametric body to 3D body scans.", "vitruvian");
  const std::string version = std::string("vitruvian ") + VITRUVIAN_VERSION;
  app.set_help_flag("--help,-h", "show this text");
  app.set_version_flag("--version", version);
  app.require_subcommand(0, 1);
  app.footer(
      "Exit status: 0 all ok, 1 a verdict is doubtful or failed, 2 wrong usage, 3 a scan could not be read,\n"
      "4 an output could not be written or an internal error, 130 interrupted.");

  RegisterArguments registering;
  Pending pending;
  CLI::App& register_command = *app.add_subcommand("register", "fit the body to scans");
  register_command
      .add_option("SCAN", registering.scans, "PLY, OBJ, STL, OFF, GLB, XYZ or PCD file, gzipped or not")
      ->required()
      ->type_name("");
  add_method_options(register_command, registering, pending);
  add_model_options(register_command, registering);
  add_scan_options(register_command, registering);
  add_output_options(register_command, registering);

  CLI::App& measure_command =
      *app.add_subcommand("measure", "lengths, girths, volumes and sections of a registration");
  MeasureArguments measuring;
  add_measure_options(measure_command, measuring);

  EvaluateArguments evaluating;
  CLI::App& evaluate_command =
      *app.add_subcommand("evaluate", "joint errors of a registration against known joints, as JSON");
  evaluate_command.add_option("REGISTRATION", evaluating.registration_file, "a registration.json")
      ->required()
      ->type_name("");
  evaluate_command.add_option("--truth", evaluating.truth_file, "known joints of the scan")
      ->required()
      ->type_name("TRUTH.json");

  ModelInfoArguments informing;
  CLI::App& model_command = *app.add_subcommand("model", "look into body models");
  model_command.require_subcommand(1);
  CLI::App& info_command = *model_command.add_subcommand("info", "print what a body model file holds");
  info_command.add_option("FILE", informing.file, "body model file")->required()->type_name("");

  std::string help_about;
  CLI::App& help_command = *app.add_subcommand("help", "help on a command");
  help_command.add_option("COMMAND", help_about, "register, measure, evaluate or model")->type_name("");

  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp&) {
    return PrintArguments{app.help()};
  } catch (const CLI::CallForVersion&) {
    return PrintArguments{version + "\n"};
  } catch (const CLI::ParseError& error) {
    std::string about;
    for (const CLI::App* used : app.get_subcommands()) about = " " + used->get_name();
    throw Error(ErrorCode::usage, first_line(error.what()) + "\nRun: vitruvian help" + about);
  }
  if (help_command.parsed()) {
    if (help_about.empty()) {
      return PrintArguments{app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal)};
    }
    for (const CLI::App* command : app.get_subcommands(nullptr)) {
      if (command->get_name() == help_about) return PrintArguments{command->help(app.get_name())};
    }
    throw Error(ErrorCode::usage, "there is no command \"" + help_about + "\"\nRun: vitruvian help");
  }
  if (register_command.parsed()) {
    settle_register(register_command, pending, registering);
    return registering;
  }
  if (measure_command.parsed()) return measuring;
  if (evaluate_command.parsed()) return evaluating;
  if (info_command.parsed()) return informing;
  throw Error(ErrorCode::usage, "a command is missing\nRun: vitruvian help");
}

}  // namespace vitruvian
