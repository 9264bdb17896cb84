// Made by `scripts/measurement_error --scanner FOLDER --source FILE` from scans of 14 people; not to be
// edited.
#include "anthropometry/dimension_errors.h"

#include <array>

namespace vitruvian {
namespace {

constexpr std::array kErrors = {
    // clang-format off
    DimensionError{"ankle_breadth", 4.16, 1.63},
    DimensionError{"ankle_girth", 17.59, 2.17},
    DimensionError{"ankle_height", 5.80, 1.99},
    DimensionError{"arm_length", 8.98, 2.07},
    DimensionError{"axilla_height", 7.35, 2.34},
    DimensionError{"back_waist_length", 8.51, 2.46},
    DimensionError{"biacromial_breadth", 8.88, 2.57},
    DimensionError{"bideltoid_breadth", 9.12, 3.40},
    DimensionError{"biiliac_breadth", 5.77, 1.93},
    DimensionError{"bitragion_arc", 9.36, 3.26},
    DimensionError{"bust_girth", 22.22, 2.46},
    DimensionError{"bust_height", 21.05, 2.34},
    DimensionError{"bust_point_distance", 25.71, 3.38},
    DimensionError{"buttock_knee_length", 1.61, 1.76},
    DimensionError{"buttock_popliteal_length", 4.20, 1.76},
    DimensionError{"calf_girth", 5.97, 1.63},
    DimensionError{"cervicale_height", 7.95, 2.34},
    DimensionError{"cervicale_height_sitting", 6.91, 2.66},
    DimensionError{"chest_breadth", 7.44, 2.46},
    DimensionError{"chest_depth", 7.42, 2.46},
    DimensionError{"chest_girth", 22.19, 2.46},
    DimensionError{"crotch_height", 3.79, 2.05},
    DimensionError{"elbow_breadth", 2.02, 3.40},
    DimensionError{"elbow_girth", 9.62, 3.40},
    DimensionError{"elbow_wrist_length", 11.54, 1.57},
    DimensionError{"face_length", 5.59, 3.26},
    DimensionError{"foot_breadth", 6.32, 2.25},
    DimensionError{"foot_length", 8.88, 2.08},
    DimensionError{"forearm_fingertip_length", 17.73, 4.08},
    DimensionError{"forearm_girth", 7.37, 1.57},
    DimensionError{"hand_breadth", 4.55, 2.54},
    DimensionError{"hand_girth", 11.82, 2.54},
    DimensionError{"hand_length", 14.79, 4.08},
    DimensionError{"head_breadth", 5.08, 3.26},
    DimensionError{"head_girth", 8.66, 3.26},
    DimensionError{"head_length", 4.69, 3.26},
    DimensionError{"head_sagittal_arc", 10.23, 3.26},
    DimensionError{"high_hip_girth", 13.19, 2.17},
    DimensionError{"hip_breadth", 1.84, 2.17},
    DimensionError{"hip_breadth_sitting", 3.89, 1.78},
    DimensionError{"hip_girth", 4.61, 2.17},
    DimensionError{"iliac_crest_height", 9.41, 2.05},
    DimensionError{"iliac_spine_height", 11.17, 2.05},
    DimensionError{"knee_breadth", 3.74, 1.71},
    DimensionError{"knee_girth", 10.97, 1.63},
    DimensionError{"knee_height", 8.91, 1.99},
    DimensionError{"knee_height_sitting", 6.93, 1.77},
    DimensionError{"lower_knee_girth", 9.85, 1.63},
    DimensionError{"mid_thigh_girth", 4.75, 1.71},
    DimensionError{"minimum_leg_girth", 7.53, 1.63},
    DimensionError{"neck_base_girth", 10.98, 2.46},
    DimensionError{"neck_girth", 11.33, 2.39},
    DimensionError{"popliteal_height", 5.35, 1.77},
    DimensionError{"shoulder_height", 5.04, 2.18},
    DimensionError{"shoulder_height_sitting", 3.60, 2.25},
    DimensionError{"shoulder_length", 5.53, 2.57},
    DimensionError{"shoulder_width", 10.52, 2.84},
    DimensionError{"sitting_height", 4.03, 2.60},
    DimensionError{"stature", 5.90, 2.08},
    DimensionError{"suprasternale_height", 10.86, 2.34},
    DimensionError{"thigh_girth", 7.34, 1.71},
    DimensionError{"tibial_height", 8.28, 1.99},
    DimensionError{"trochanter_height", 10.38, 2.05},
    DimensionError{"trunk_length", 7.31, 2.66},
    DimensionError{"under_bust_girth", 21.32, 2.46},
    DimensionError{"upper_arm_girth", 11.68, 3.40},
    DimensionError{"upper_arm_length", 6.38, 2.07},
    DimensionError{"upper_chest_girth", 25.90, 2.46},
    DimensionError{"waist_breadth", 4.17, 2.46},
    DimensionError{"waist_depth", 2.04, 2.46},
    DimensionError{"waist_girth", 5.65, 2.46},
    DimensionError{"waist_girth_minimum", 4.70, 2.46},
    DimensionError{"waist_girth_omphalion", 8.93, 2.46},
    DimensionError{"waist_height", 8.43, 1.97},
    DimensionError{"wrist_breadth", 3.77, 1.57},
    DimensionError{"wrist_girth", 10.58, 1.57},
    // clang-format on
};

}  // namespace

std::span<const DimensionError> dimension_errors() { return kErrors; }

}  // namespace vitruvian
