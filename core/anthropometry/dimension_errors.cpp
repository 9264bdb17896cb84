// Made by `scripts/measurement_error --scanner FOLDER --source FILE` from scans of 17 people; not to be
// edited.
#include "anthropometry/dimension_errors.h"

#include <array>

namespace vitruvian {
namespace {

constexpr std::array kErrors = {
    // clang-format off
    DimensionError{"ankle_breadth", {5.56, 1.63}, {1.29, 0.40}},
    DimensionError{"ankle_girth", {16.38, 2.17}, {16.82, 0.66}},
    DimensionError{"ankle_height", {7.46, 2.04}, {5.39, 0.84}},
    DimensionError{"arm_length", {8.58, 2.09}, {7.39, 0.39}},
    DimensionError{"axilla_height", {7.64, 2.40}, {5.00, 0.94}},
    DimensionError{"back_waist_length", {11.08, 2.45}, {10.87, 0.62}},
    DimensionError{"biacromial_breadth", {8.33, 2.55}, {7.46, 0.40}},
    DimensionError{"bideltoid_breadth", {8.39, 3.43}, {1.32, 0.88}},
    DimensionError{"biiliac_breadth", {5.28, 1.87}, {3.71, 0.77}},
    DimensionError{"bitragion_arc", {9.48, 3.26}, {4.75, 1.82}},
    DimensionError{"bust_girth", {20.76, 2.45}, {18.88, 0.62}},
    DimensionError{"bust_height", {20.96, 2.39}, {19.87, 0.84}},
    DimensionError{"bust_point_distance", {24.14, 3.37}, {21.57, 0.41}},
    DimensionError{"buttock_knee_length", {1.66, 1.72}, {1.71, 0.56}},
    DimensionError{"buttock_popliteal_length", {3.89, 1.72}, {3.31, 0.56}},
    DimensionError{"calf_girth", {5.52, 1.63}, {3.78, 0.40}},
    DimensionError{"cervicale_height", {8.95, 2.39}, {5.40, 0.84}},
    DimensionError{"cervicale_height_sitting", {7.13, 2.62}, {5.27, 0.59}},
    DimensionError{"chest_breadth", {7.06, 2.45}, {7.14, 0.62}},
    DimensionError{"chest_depth", {7.17, 2.45}, {2.90, 0.62}},
    DimensionError{"chest_girth", {23.14, 2.45}, {7.51, 0.62}},
    DimensionError{"crotch_height", {3.86, 2.09}, {2.67, 0.91}},
    DimensionError{"elbow_breadth", {1.97, 3.43}, {1.79, 0.88}},
    DimensionError{"elbow_girth", {10.93, 3.43}, {3.64, 0.88}},
    DimensionError{"elbow_wrist_length", {11.14, 1.62}, {10.29, 0.38}},
    DimensionError{"face_length", {5.40, 3.26}, {1.73, 1.82}},
    DimensionError{"foot_breadth", {6.85, 2.33}, {3.69, 1.42}},
    DimensionError{"foot_length", {9.99, 2.14}, {2.81, 0.95}},
    DimensionError{"forearm_fingertip_length", {17.75, 3.96}, {20.25, 1.94}},
    DimensionError{"forearm_girth", {8.22, 1.62}, {2.14, 0.38}},
    DimensionError{"hand_breadth", {4.70, 2.41}, {9.32, 0.63}},
    DimensionError{"hand_girth", {12.09, 2.41}, {22.77, 0.63}},
    DimensionError{"hand_length", {16.05, 3.96}, {16.50, 1.94}},
    DimensionError{"head_breadth", {4.96, 3.26}, {0.92, 1.82}},
    DimensionError{"head_girth", {7.99, 3.26}, {2.66, 1.82}},
    DimensionError{"head_length", {4.46, 3.26}, {0.93, 1.82}},
    DimensionError{"head_sagittal_arc", {9.69, 3.26}, {8.02, 1.82}},
    DimensionError{"high_hip_girth", {12.41, 2.17}, {9.65, 0.66}},
    DimensionError{"hip_breadth", {1.68, 2.17}, {1.81, 0.66}},
    DimensionError{"hip_breadth_sitting", {3.54, 1.73}, {2.33, 0.60}},
    DimensionError{"hip_girth", {4.49, 2.17}, {3.75, 0.66}},
    DimensionError{"iliac_crest_height", {11.24, 2.09}, {9.88, 0.91}},
    DimensionError{"iliac_spine_height", {11.53, 2.09}, {10.38, 0.91}},
    DimensionError{"knee_breadth", {3.68, 1.66}, {2.11, 0.52}},
    DimensionError{"knee_girth", {10.09, 1.63}, {3.51, 0.40}},
    DimensionError{"knee_height", {8.52, 2.04}, {7.38, 0.84}},
    DimensionError{"knee_height_sitting", {6.70, 1.79}, {5.12, 0.44}},
    DimensionError{"lower_knee_girth", {9.02, 1.63}, {3.05, 0.40}},
    DimensionError{"mid_thigh_girth", {5.50, 1.66}, {4.05, 0.52}},
    DimensionError{"minimum_leg_girth", {7.86, 1.63}, {1.98, 0.40}},
    DimensionError{"neck_base_girth", {10.77, 2.45}, {10.04, 0.62}},
    DimensionError{"neck_girth", {12.39, 2.54}, {2.15, 0.34}},
    DimensionError{"popliteal_height", {5.45, 1.79}, {4.19, 0.44}},
    DimensionError{"shoulder_height", {5.26, 2.22}, {4.32, 0.84}},
    DimensionError{"shoulder_height_sitting", {3.74, 2.21}, {4.33, 0.58}},
    DimensionError{"shoulder_length", {5.77, 2.55}, {5.34, 0.40}},
    DimensionError{"shoulder_width", {10.49, 2.83}, {9.58, 0.40}},
    DimensionError{"sitting_height", {3.77, 2.56}, {2.10, 1.29}},
    DimensionError{"stature", {5.67, 2.14}, {2.28, 0.95}},
    DimensionError{"suprasternale_height", {12.06, 2.39}, {7.19, 0.84}},
    DimensionError{"thigh_girth", {6.76, 1.66}, {4.45, 0.52}},
    DimensionError{"tibial_height", {7.99, 2.04}, {7.31, 0.84}},
    DimensionError{"trochanter_height", {11.29, 2.09}, {9.87, 0.91}},
    DimensionError{"trunk_length", {7.85, 2.62}, {6.75, 0.59}},
    DimensionError{"under_bust_girth", {19.97, 2.45}, {19.65, 0.62}},
    DimensionError{"upper_arm_girth", {10.98, 3.43}, {2.77, 0.88}},
    DimensionError{"upper_arm_length", {6.00, 2.09}, {5.90, 0.39}},
    DimensionError{"upper_chest_girth", {26.55, 2.45}, {7.01, 0.62}},
    DimensionError{"waist_breadth", {3.98, 2.45}, {2.29, 0.62}},
    DimensionError{"waist_depth", {1.88, 2.45}, {1.76, 0.62}},
    DimensionError{"waist_girth", {5.58, 2.45}, {2.99, 0.62}},
    DimensionError{"waist_girth_minimum", {4.37, 2.45}, {2.14, 0.62}},
    DimensionError{"waist_girth_omphalion", {8.45, 2.45}, {7.00, 0.62}},
    DimensionError{"waist_height", {11.23, 1.99}, {9.44, 0.82}},
    DimensionError{"wrist_breadth", {4.12, 1.62}, {1.98, 0.38}},
    DimensionError{"wrist_girth", {11.83, 1.62}, {5.03, 0.38}},
    // clang-format on
};

}  // namespace

std::span<const DimensionError> dimension_errors() { return kErrors; }

}  // namespace vitruvian
