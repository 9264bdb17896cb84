#include "cli/model_command.h"

#include <array>
#include <iomanip>

#include "io/file.h"
#include "smpl/read_model.h"

namespace vitruvian {

ExitStatus run_model_info(const ModelInfoArguments& arguments, const CliContext& context) {
  const FileBytes file(arguments.file);
  SmplOptions everything;
  everything.betas = kEveryBeta;
  everything.expressions = kEveryBeta;
  const BodyModel model = read_any_body_model(file.bytes(), arguments.file, everything);
  std::ostream& out = context.out;
  const Eigen::Vector3f extent =
      model.v_template.rowwise().maxCoeff() - model.v_template.rowwise().minCoeff();
  out << "name        " << model.name << "\nfamily      " << model.family << "\nsha256      " << model.sha256
      << "\nvertices    " << model.vertex_count() << "\nfaces       " << model.face_count()
      << "\njoints      " << model.joint_count() << "\nbetas       " << model.shape_count()
      << "\nexpression  " << model.expression_count << "\nhand poses  "
      << (model.hands[0].mean.size() > 0 && model.hands[1].mean.size() > 0 ? "yes" : "no") << "\ngender      "
      << (model.gender ? name_of(*model.gender) : "not said") << "\ncorrectives " << model.corrective.size()
      << (model.mirror.empty() ? "\nsymmetric   no" : "\nsymmetric   yes") << std::fixed
      << std::setprecision(3) << "\nstature_m   " << extent.y() << " (mean shape)\nsegments    vertices\n";
  std::array<int, 24> counts{};
  for (const std::uint8_t segment : model.segment) ++counts[segment];
  for (std::size_t s = 0; s < counts.size(); ++s) {
    out << "  " << std::left << std::setw(18) << kSegmentNames[s] << std::right << std::setw(6) << counts[s]
        << "\n";
  }
  return ExitStatus::ok;
}

}  // namespace vitruvian
