// vitruvian-make-scans BODY.vbm POSES.csv OUT_DIR [SEED [COUNT]]: scans of the body model itself with known
// joints, for benchmarks. A row of POSES.csv holds 72 axis-angle numbers (24 joints, root first). Shapes are
// random; the surface is remeshed so that no scan vertex coincides with a model vertex; every scan is turned
// by a random yaw.
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "base/random.h"
#include "body/forward.h"
#include "io/file.h"
#include "io/mesh_writer.h"

namespace {
using namespace vitruvian;

constexpr double kShapeSpread = 0.9;

std::vector<Points3d> read_poses(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorCode::cannot_read, path + ": cannot be read");
  std::vector<Points3d> poses;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream row(line);
    Points3d pose(3, 24);
    for (Index i = 0; i < pose.size(); ++i) {
      std::string cell;
      if (!std::getline(row, cell, ','))
        throw Error(ErrorCode::bad_file, path + ": a row has fewer than 72 numbers");
      pose.data()[i] = std::strtod(cell.c_str(), nullptr);
    }
    poses.push_back(pose);
  }
  return poses;
}

/// One vertex inside each old face (random place), one polygon round each old vertex, cut into triangles.
void remesh(const Points3d& vertices, const Faces& faces, Random& random, Points3d& new_vertices,
            Faces& new_faces) {
  new_vertices.resize(3, faces.cols());
  std::map<std::pair<int, int>, int> face_of_edge;  // directed edge -> face on its left
  for (Index f = 0; f < faces.cols(); ++f) {
    Vec3d weights(random.uniform(0.15, 1), random.uniform(0.15, 1), random.uniform(0.15, 1));
    weights /= weights.sum();
    new_vertices.col(f).setZero();
    for (int k = 0; k < 3; ++k) {
      new_vertices.col(f) += weights[k] * vertices.col(faces(k, f));
      face_of_edge[{faces(k, f), faces((k + 1) % 3, f)}] = static_cast<int>(f);
    }
  }
  std::vector<std::array<int, 3>> triangles;
  std::vector<bool> done(vertices.cols(), false);
  for (Index f = 0; f < faces.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int centre = faces(k, f);
      if (done[centre]) continue;
      done[centre] = true;
      // Walk round the vertex: from each face across the edge that ends in it.
      std::vector<int> ring;
      int face = static_cast<int>(f);
      do {
        ring.push_back(face);
        int corner = 0;
        while (faces(corner, face) != centre) ++corner;
        const int previous = faces((corner + 2) % 3, face);
        face = face_of_edge.at({centre, previous});
      } while (face != static_cast<int>(f));
      for (std::size_t i = 2; i < ring.size(); ++i) triangles.push_back({ring[0], ring[i - 1], ring[i]});
    }
  }
  new_faces.resize(3, static_cast<Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) new_faces(k, static_cast<Index>(i)) = triangles[i][k];
  }
}

std::string truth_json(const BodyModel& body, const Points3d& joints) {
  std::ostringstream text;
  text.precision(9);
  text << "{\"frame\": \"scan\", \"unit\": \"m\", \"joints\": {";
  for (int j = 0; j < body.joint_count(); ++j) {
    text << (j ? ", " : "") << '"' << body.joint_names[j] << "\": [" << joints(0, j) << ", " << joints(1, j)
         << ", " << joints(2, j) << ']';
  }
  text << "}}\n";
  return text.str();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: vitruvian-make-scans BODY.vbm POSES.csv OUT_DIR [SEED [COUNT]]\n");
    return 2;
  }
  try {
    const BodyModel body = read_body_model(FileBytes(argv[1]).bytes(), argv[1]);
    const std::vector<Points3d> poses = read_poses(argv[2]);
    const std::string folder = argv[3];
    make_folders(folder);
    Random random(argc > 4 ? static_cast<std::uint32_t>(std::atoi(argv[4])) : 1);
    const std::size_t count = argc > 5 ? static_cast<std::size_t>(std::atoi(argv[5])) : poses.size();
    for (std::size_t i = 0; i < count && i < poses.size(); ++i) {
      Eigen::VectorXd betas(body.beta_count());
      for (Index k = 0; k < betas.size(); ++k) betas[k] = kShapeSpread * random.normal();
      BodyState state = BodyState::from_axis_angle(poses[i], betas, Vec3d::Zero());
      const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
      state.rotation[0] = Eigen::AngleAxisd(yaw, Vec3d::UnitY()).toRotationMatrix() * state.rotation[0];
      Points3d vertices;
      Faces faces;
      remesh(posed_vertices<double>(body, state), body.faces, random, vertices, faces);
      char name[32];
      std::snprintf(name, sizeof name, "body_%03zu", i);
      write_file(folder + "/" + name + ".ply", to_ply({.vertices = vertices, .faces = faces}));
      write_file(folder + "/" + name + ".truth.json", truth_json(body, pose_skeleton(body, state).joints));
    }
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
