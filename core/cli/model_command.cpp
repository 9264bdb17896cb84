#include "cli/model_command.h"

#include <array>
#include <iomanip>

#include "body/model.h"
#include "io/file.h"

namespace vitruvian {

ExitStatus run_model_info(const ModelInfoArguments& arguments, const CliContext& context) {
  BodyModel model;
  try {
    const FileBytes file(arguments.file);
    model = read_body_model(file.bytes(), arguments.file);
  } catch (const Error& error) {
    context.error << "vitruvian: " << error.what() << "\n";
    return ExitStatus::unreadable;
  }
  std::ostream& out = context.out;
  const Eigen::Vector3f extent =
      model.v_template.rowwise().maxCoeff() - model.v_template.rowwise().minCoeff();
  out << "name        " << model.name << "\nfamily      " << model.family << "\nsha256      " << model.sha256
      << "\nvertices    " << model.vertex_count() << "\nfaces       " << model.face_count()
      << "\njoints      " << model.joint_count() << "\nbetas       " << model.beta_count() << "\ncorrectives "
      << model.corrective.size() << (model.mirror.empty() ? "\nsymmetric   no" : "\nsymmetric   yes")
      << std::fixed << std::setprecision(3) << "\nstature_m   " << extent.y()
      << " (mean shape)\nsegments    vertices\n";
  std::array<int, 24> counts{};
  for (const std::uint8_t segment : model.segment) ++counts[segment];
  for (std::size_t s = 0; s < counts.size(); ++s) {
    out << "  " << std::left << std::setw(18) << kSegmentNames[s] << std::right << std::setw(6) << counts[s]
        << "\n";
  }
  return ExitStatus::ok;
}

}  // namespace vitruvian
