#include "session.h"

#include <Eigen/LU>
#include <chrono>
#include <utility>

#include "base/sha256.h"
#include "io/mesh_writer.h"
#include "measured_report.h"
#include "pipeline/body_parameters.h"
#include "pipeline/report.h"
#include "pipeline/result_json.h"
#include "pipeline/result_json_value.h"
#include "session_json.h"

namespace vitruvian::wasm {
namespace {

/// Scans with more vertices are shown thinned, to about so many: more than a screen shows of a person, and
/// few enough to go to a graphics card at once.
constexpr int kLargestWhole = 100'000;
constexpr int kThinned = 60'000;

std::string mesh_text(const Registration& registration, const std::string& format) {
  MeshView mesh{registration.registered_vertices, registration.registered_faces};
  mesh.values = registration.vertex_error_mm;
  mesh.value_name = "error_mm";
  if (format == "ply") return to_ply(mesh);
  if (format == "obj") return to_obj(mesh);
  if (format == "glb") return to_glb(mesh, registration.alignment.body_from_scan);
  throw Error(ErrorCode::usage, "unknown mesh format \"" + format + "\"");
}

constexpr PipelineStage kStages[] = {PipelineStage::align, PipelineStage::keypoints, PipelineStage::pose,
                                     PipelineStage::fit};

}  // namespace

Session::~Session() { task_.stop(); }

void Session::use_models(const std::string& known_landmarks) {
  task_.require_idle();
  request_.reset();
  changing_models_ = false;
  task_.start([this, known_landmarks] {
    task_.execution().progress("model", -1);
    models_.begin(known_landmarks, task_.execution());
    changing_models_ = true;
    advance();
  });
}

void Session::open(Buffer file, std::string name) {
  task_.require_idle();
  drop_findings();
  scan_.reset();
  shown_ = {};
  // std::function wants what it holds to be copyable.
  auto held = std::make_shared<Buffer>(std::move(file));
  task_.start([this, held, name = std::move(name)] {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point began = Clock::now();
    task_.execution().progress("read", 0);
    Scan scan = read_scan(held->bytes(), name, task_.execution());
    *held = Buffer();
    read_ms_ = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
    const Points3f normals = Points3f::Zero(3, scan.vertices.cols());
    shown_ = cluster_decimate(scan.vertices, normals, scan.faces,
                              scan.vertices.cols() > kLargestWhole ? kThinned : kLargestWhole);
    shown_.normals = vertex_normals(shown_.vertices, shown_.faces);
    scan_ = std::make_shared<const Scan>(std::move(scan));
  });
}

std::string Session::scan_report() const {
  if (!scan_) throw Error(ErrorCode::internal, "no scan is open");
  return text_of(describe_scan(*scan_, shown_));
}

bool Session::holds(PipelineStage stage) const {
  return pipeline_ && pipeline_->reached(stage) && (stage != PipelineStage::fit || registration_);
}

int Session::configure(const std::string& settings) {
  task_.require_idle();
  Settings chosen = parse_settings(settings);
  chosen.threads = task_.execution().threads();
  if (pipeline_) pipeline_->configure(chosen);
  settings_ = chosen;
  editor_.reset();
  if (!holds(PipelineStage::fit)) drop_result();
  int count = 0;
  while (count < kPipelineStageCount && holds(kStages[count])) ++count;
  return count;
}

void Session::begin(int until, bool again) {
  task_.require_idle();
  if (!scan_) throw Error(ErrorCode::usage, "open a scan first");
  if (until < 0 || until >= kPipelineStageCount) throw Error(ErrorCode::internal, "unknown stage");
  until_ = kStages[until];
  models_.abandon();
  changing_models_ = false;
  if (!pipeline_) {
    pipeline_ = std::make_unique<RegistrationPipeline>(models_.models(), settings_, task_.execution());
    pipeline_->on_energy([this](std::string_view curve, int iteration, double energy) {
      task_.tell_energy(curve, iteration, energy);
    });
    pipeline_->set_read_time(read_ms_);
  }
  // What a cancelled run left behind of a stage is worked again.
  for (const PipelineStage stage : kStages) {
    if (holds(stage) && !(again && stage == until_)) continue;
    pipeline_->forget(stage);
    drop_result();
    break;
  }
  request_.reset();
  task_.start([this] {
    if (!pipeline_->has_scan()) pipeline_->set_scan(scan_);
    advance();
  });
}

void Session::resume() {
  if (!request_) throw Error(ErrorCode::internal, "no network request is open");
  task_.start([this] {
    if (changing_models_) {
      models_.accept(reply_);
    } else {
      pipeline_->accept(reply_);
    }
    advance();
  });
}

void Session::advance() {
  request_ = changing_models_ ? models_.next_request() : pipeline_->next_request(until_);
  reply_ = {};
  if (request_) {
    reply_.outputs.resize(request_->inputs.size());
    return;
  }
  if (std::exchange(changing_models_, false)) {
    drop_findings();
    return;
  }
  if (until_ != PipelineStage::fit || registration_) return;
  registration_ = pipeline_->finish();
  keep_result();
}

void Session::keep_result() {
  const Mat4d& body_from_scan = registration_->alignment.body_from_scan;
  body_vertices_ = ((body_from_scan.topLeftCorner<3, 3>() * registration_->registered_vertices).colwise() +
                    body_from_scan.topRightCorner<3, 1>())
                       .cast<float>();
}

void Session::drop_findings() {
  pipeline_.reset();
  drop_result();
  lesson_.reset();
  unchanged_.reset();
  editor_.reset();
  painter_.reset();
}

void Session::drop_result() {
  measured_.reset();
  registration_.reset();
}

std::string Session::request_report() const {
  return text_of(request_ ? describe_request(*request_) : nlohmann::json());
}

float* Session::reply_buffer(std::size_t input, std::size_t output, std::size_t size) {
  if (input >= reply_.outputs.size())
    throw Error(ErrorCode::internal, "a reply to an input that was not asked for");
  NetworkOutputs& outputs = reply_.outputs[input];
  if (output >= outputs.size()) outputs.resize(output + 1);
  outputs[output].resize(size);
  return outputs[output].data();
}

nlohmann::json Session::describe_pose() {
  const BodyState& state = pipeline_->initial_pose();
  const BodyModel& body = models_.models().body;
  posed_vertices_ = posed_vertices<float>(body, state);
  const Faces& faces = body.faces;
  return {{"joints", describe_joints(body, state)},
          {"body", array_reference(posed_vertices_.data(), posed_vertices_.size())},
          {"faces", array_reference(faces.data(), faces.size())}};
}

nlohmann::json Session::describe_result() const {
  const Registration& r = *registration_;
  return {
      {"registration", nlohmann::json::parse(registration_json(r, VITRUVIAN_VERSION, JsonStyle::compact))},
      {"body", array_reference(body_vertices_.data(), body_vertices_.size())},
      {"faces", array_reference(r.registered_faces.data(), r.registered_faces.size())},
      {"errors_mm",
       array_reference(r.vertex_error_mm.data(), static_cast<std::ptrdiff_t>(r.vertex_error_mm.size()))}};
}

std::string Session::findings_report() {
  nlohmann::json report = {
      {"align", nullptr}, {"keypoints", nullptr}, {"pose", nullptr}, {"result", nullptr}};
  if (holds(PipelineStage::align)) report["align"] = describe_alignment(pipeline_->align_finding());
  if (holds(PipelineStage::keypoints)) {
    report["keypoints"] = {{"views", describe_views(*pipeline_->landmark_stage())},
                           {"joints", describe_keypoints(pipeline_->keypoints())}};
  }
  if (holds(PipelineStage::pose)) report["pose"] = describe_pose();
  if (holds(PipelineStage::fit)) report["result"] = describe_result();
  return text_of(report);
}

std::string Session::edit(const std::string& request) {
  task_.require_idle();
  if (!scan_) throw Error(ErrorCode::usage, "open a scan first");
  const nlohmann::json asked = parse_json(request, "editor");
  if (Painter::takes(asked)) return text_of(paint(asked));
  return text_of(editor_.answer(asked, {models_.models(), *scan_, shown_, settings_, pipeline_.get()}));
}

nlohmann::json Session::paint(const nlohmann::json& request) {
  if (!holds(PipelineStage::pose)) throw Error(ErrorCode::usage, "pose the body first");
  const bool is_fitted = registration_ && registration_->parameters;
  const BodyState posed =
      is_fitted ? state_of(models_.models().body, *registration_->parameters) : pipeline_->initial_pose();
  return painter_.answer(request, {models_.models(), *scan_, shown_, posed,
                                   pipeline_->align_finding().alignment.body_from_scan});
}

std::string Session::files_report(const std::string& mesh_format) {
  if (!registration_) throw Error(ErrorCode::internal, "nothing has been registered");
  const bool has_mesh =
      registration_->verdict.status != VerdictStatus::failed && registration_->registered_vertices.cols() > 0;
  std::vector<ExportedFile> files = {
      {"registration.json", registration_json(*registration_, VITRUVIAN_VERSION, JsonStyle::pretty)}};
  if (has_mesh) {
    files.push_back({"registered." + mesh_format, mesh_text(*registration_, mesh_format)});
    if (registration_->surface_error)
      files.push_back({"errors.csv", errors_csv(*registration_->surface_error)});
    if (registration_->offsets.cols() > 0) {
      files.push_back({kOffsetsFile, offsets_npz(registration_->offsets)});
    }
  }
  return describe_files(std::move(files));
}

std::string Session::describe_files(std::vector<ExportedFile> files) {
  files_ = std::move(files);
  nlohmann::json list = nlohmann::json::array();
  for (const ExportedFile& file : files_) {
    list.push_back(
        {{"name", file.name},
         {"data", array_reference(file.content.data(), static_cast<std::ptrdiff_t>(file.content.size()))}});
  }
  return text_of({{"files", list}});
}

const MeasuredRegistration& Session::measured() {
  task_.require_idle();
  if (!registration_) throw Error(ErrorCode::internal, "nothing has been registered");
  if (!measured_) {
    const std::string text = registration_json(*registration_, VITRUVIAN_VERSION, JsonStyle::pretty);
    measured_ = std::make_unique<MeasuredRegistration>(
        *registration_, models_.models().body, registration_->offsets.cast<double>(),
        to_hex(sha256(std::as_bytes(std::span(text.data(), text.size())))));
    measured_->set_vertex_errors(registration_->vertex_error_mm);
    standing_vertices_ = measured_->in_place(Posture::standing).cast<float>();
    seated_vertices_ = measured_->in_place(Posture::sitting).cast<float>();
  }
  return *measured_;
}

std::string Session::measurements_report() {
  nlohmann::json report = describe_measurements(measured());
  report["standing"] = array_reference(standing_vertices_.data(), standing_vertices_.size());
  report["seated"] = array_reference(seated_vertices_.data(), seated_vertices_.size());
  report["faces"] = array_reference(models_.models().body.faces.data(), models_.models().body.faces.size());
  return text_of(report);
}

std::string Session::profile_report(const std::string& segment, int count) {
  return text_of(describe_profile(measured(), segment, count));
}

std::string Session::measured_files_report(const std::string& format) {
  return describe_files(measured_files(measured(), format));
}

std::string Session::pose_body(const std::string& parameters) {
  posed_ = wasm::pose_body(models_.models().body, parameters);
  return text_of(describe_posed(posed_));
}

void Session::begin_lesson(const std::string& settings) {
  task_.require_idle();
  if (!holds(PipelineStage::keypoints)) throw Error(ErrorCode::usage, "find the keypoints first");
  lesson_.reset();
  unchanged_.reset();
  const LessonSettings chosen = parse_lesson(settings);
  task_.start([this, chosen] {
    unchanged_ = run_lesson(*pipeline_, {}, task_.execution());
    lesson_ = chosen == LessonSettings() ? unchanged_ : run_lesson(*pipeline_, chosen, task_.execution());
  });
}

std::string Session::lesson_report() const {
  if (!lesson_) throw Error(ErrorCode::internal, "no lesson has been run");
  return text_of(describe_lesson(*lesson_, *unchanged_));
}

}  // namespace vitruvian::wasm
