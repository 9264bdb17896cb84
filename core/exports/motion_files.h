#pragma once

#include <string>

#include "exports/exported_body.h"

namespace vitruvian {

/// AMASS-style .npz of one frame: poses [1,156] (22 body joints, then the fingers; zero without them),
/// trans [1,3], betas, dmpls [1,8] (zero without soft tissue), gender, mocap_framerate. It has no face: a
/// SMPL-X body's jaw, eyes and expression are left out. Metres, Z up as in AMASS: the body frame turned by 90
/// degrees about X.
std::string to_amass_npz(const ExportedBody& body);

/// .smpl (SMPL codec): a flat .npz with camelCase keys. Metres, Y up: the body frame. SMPL+H with its hands,
/// SMPL-X also with jaw, eyes and expression. The format has no soft tissue, which is left out.
std::string to_smpl_codec(const ExportedBody& body);

/// OpenSim marker file, one frame: landmarks, then joints as "joint_NAME". Millimetres, OpenSim's axes (X
/// forward, Y up, Z to the right).
std::string to_trc(const ExportedBody& body, const std::string& file_name);

/// What OpenSim's scaling scripts ask of a subject: {"sex", "massKg", "heightM"}.
std::string to_subject_json(const ExportedBody& body);

/// OpenSim Creator's landmarks: name,x,y,z in the scan's frame and units, beside the registered mesh.
std::string to_landmark_csv(const ExportedBody& body);

}  // namespace vitruvian
