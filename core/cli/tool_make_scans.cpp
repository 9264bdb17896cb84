// vitruvian-make-scans BODY.vbm POSES.csv OUT_DIR [SEED [COUNT [VERTICES]]]: scans of the body model itself
// with known joints, for benchmarks. A row of POSES.csv holds 72 axis-angle numbers (24 joints, root first).
// Shapes are random; the surface is remeshed so that no scan vertex coincides with a model vertex; every scan
// is turned by a random yaw. Beside each scan NAME.truth.json holds its joints and NAME.surface.ply the
// body's own vertices.
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

/// Directed edge -> face on its left.
using FaceOfEdge = std::map<std::pair<int, int>, int>;

/// For each face the number 3 f + k of the edge on which it shares a new vertex with a neighbour, the lower
/// of both faces' numbers, or -1: random pairs, as many as leave `count` vertices, no old vertex losing so
/// many that its polygon would vanish.
std::vector<int> shared_edges(const Faces& faces, const FaceOfEdge& face_of_edge, Index count,
                              Random& random) {
  std::vector<int> shared(faces.cols(), -1), valence(faces.maxCoeff() + 1, 0);
  for (Index i = 0; i < faces.size(); ++i) ++valence[faces.data()[i]];
  Index left = faces.cols();
  for (Index trial = 0; left > count && trial < 20 * faces.cols(); ++trial) {
    const int f = static_cast<int>(random.below(static_cast<std::uint32_t>(faces.cols())));
    const int k = static_cast<int>(random.below(3));
    const int a = faces(k, f), b = faces((k + 1) % 3, f), other = face_of_edge.at({b, a});
    if (shared[f] >= 0 || shared[other] >= 0 || valence[a] < 5 || valence[b] < 5) continue;
    shared[f] = shared[other] = 3 * f + k;
    --valence[a];
    --valence[b];
    --left;
  }
  return shared;
}

/// One vertex inside each old face (random place), or one for two neighbours where `count` asks for fewer;
/// one polygon round each old vertex, cut into triangles. @param count  0: a vertex for every face.
void remesh(const Points3d& vertices, const Faces& faces, Index count, Random& random, Points3d& new_vertices,
            Faces& new_faces) {
  new_vertices.resize(3, faces.cols());
  FaceOfEdge face_of_edge;
  for (Index f = 0; f < faces.cols(); ++f) {
    Vec3d weights(random.uniform(0.15, 1), random.uniform(0.15, 1), random.uniform(0.15, 1));
    weights /= weights.sum();
    new_vertices.col(f).setZero();
    for (int k = 0; k < 3; ++k) {
      new_vertices.col(f) += weights[k] * vertices.col(faces(k, f));
      face_of_edge[{faces(k, f), faces((k + 1) % 3, f)}] = static_cast<int>(f);
    }
  }
  std::vector<int> place(faces.cols());
  if (count > 0 && count < faces.cols()) {
    const std::vector<int> shared = shared_edges(faces, face_of_edge, count, random);
    std::map<int, int> place_on_edge;
    int used = 0;
    for (Index f = 0; f < faces.cols(); ++f) {
      place[f] = used;
      if (shared[f] >= 0) {
        const auto [entry, fresh] = place_on_edge.try_emplace(shared[f], used);
        place[f] = entry->second;
        if (!fresh) continue;
        const int owner = shared[f] / 3, k = shared[f] % 3;
        const double t = random.uniform(0.2, 0.8);
        new_vertices.col(used++) =
            t * vertices.col(faces(k, owner)) + (1 - t) * vertices.col(faces((k + 1) % 3, owner));
      } else {
        new_vertices.col(used++) = Vec3d(new_vertices.col(f));
      }
    }
    new_vertices.conservativeResize(3, used);
  } else {
    for (Index f = 0; f < faces.cols(); ++f) place[f] = static_cast<int>(f);
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
        if (ring.empty() || ring.back() != place[face]) ring.push_back(place[face]);
        int corner = 0;
        while (faces(corner, face) != centre) ++corner;
        const int previous = faces((corner + 2) % 3, face);
        face = face_of_edge.at({centre, previous});
      } while (face != static_cast<int>(f));
      if (ring.back() == ring.front()) ring.pop_back();
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
    std::fprintf(stderr,
                 "usage: vitruvian-make-scans BODY.vbm POSES.csv OUT_DIR [SEED [COUNT [VERTICES]]]\n");
    return 2;
  }
  try {
    const BodyModel body = read_body_model(FileBytes(argv[1]).bytes(), argv[1]);
    const std::vector<Points3d> poses = read_poses(argv[2]);
    const std::string folder = argv[3];
    make_folders(folder);
    Random random(argc > 4 ? static_cast<std::uint32_t>(std::atoi(argv[4])) : 1);
    const std::size_t count = argc > 5 ? static_cast<std::size_t>(std::atoi(argv[5])) : poses.size();
    const Index scan_vertices = argc > 6 ? std::atoi(argv[6]) : 0;
    for (std::size_t i = 0; i < count && i < poses.size(); ++i) {
      Eigen::VectorXd betas(body.beta_count());
      for (Index k = 0; k < betas.size(); ++k) betas[k] = kShapeSpread * random.normal();
      BodyState state = BodyState::from_axis_angle(poses[i], betas, Vec3d::Zero());
      const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
      state.rotation[0] = Eigen::AngleAxisd(yaw, Vec3d::UnitY()).toRotationMatrix() * state.rotation[0];
      Points3d vertices;
      Faces faces;
      const Points3d surface = posed_vertices<double>(body, state);
      remesh(surface, body.faces, scan_vertices, random, vertices, faces);
      char name[32];
      std::snprintf(name, sizeof name, "body_%03zu", i);
      write_file(folder + "/" + name + ".ply", to_ply({.vertices = vertices, .faces = faces}));
      write_file(folder + "/" + name + ".surface.ply", to_ply({.vertices = surface, .faces = body.faces}));
      write_file(folder + "/" + name + ".truth.json", truth_json(body, pose_skeleton(body, state).joints));
    }
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
