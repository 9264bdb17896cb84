#include "anthropometry/dimension_specs.h"

#include <array>

namespace vitruvian {
namespace {

using K = DimensionKind;
using R = DimensionRegion;

constexpr std::string_view kIso7250 = "ISO 7250-1:2017", kIso8559 = "ISO 8559-1:2017",
                           kBoth = "ISO 7250-1:2017; ISO 8559-1:2017", kCaesar = "CAESAR", kNone = "";

constexpr DimensionSpec height(std::string_view id, std::string_view name, std::string_view standard,
                               bool paired, std::string_view a, std::string_view definition,
                               std::string_view b = "") {
  return {id, name, standard, definition, paired, K::height, a, b, "", R::torso, "", 0, 0};
}
constexpr DimensionSpec line(std::string_view id, std::string_view name, std::string_view standard,
                             bool paired, std::string_view a, std::string_view b,
                             std::string_view definition) {
  return {id, name, standard, definition, paired, K::distance, a, b, "", R::torso, "", 0, 0};
}
constexpr DimensionSpec level(K kind, std::string_view id, std::string_view name, std::string_view standard,
                              R region, std::string_view a, std::string_view b, std::string_view definition) {
  return {id, name, standard, definition, false, kind, a, b, "", region, "", 0, 0};
}
constexpr DimensionSpec leg(K kind, std::string_view id, std::string_view name, std::string_view standard,
                            std::string_view a, std::string_view b, std::string_view segment,
                            std::string_view definition) {
  return {id, name, standard, definition, true, kind, a, b, "", R::body_without_arms, segment, 0, 0};
}
constexpr DimensionSpec across(K kind, std::string_view id, std::string_view name, std::string_view standard,
                               bool paired, R region, std::string_view segment, std::string_view a,
                               std::string_view b, double low, double high, std::string_view definition) {
  return {id, name, standard, definition, paired, kind, a, b, "", region, segment, low, high};
}

constexpr std::array kSpecs = {
    DimensionSpec{"stature", "stature (body height)", kIso7250,
                  "vertical distance from the floor to the highest point of the body", false, K::stature, "",
                  "", "", R::torso, "", 0, 0},
    height("cervicale_height", "cervicale height", kIso8559, false, "cervicale",
           "vertical distance from the floor to the back neck point (7th cervical vertebra)"),
    height("suprasternale_height", "suprasternale height", kCaesar, false, "suprasternale",
           "vertical distance from the floor to the notch of the breastbone"),
    height("shoulder_height", "shoulder height", kIso7250, true, "*acromion",
           "vertical distance from the floor to the acromion"),
    height("axilla_height", "axilla height", kCaesar, true, "*axilla_anterior",
           "vertical distance from the floor to the front axillary fold"),
    height("bust_height", "bust height", kIso8559, true, "*thelion",
           "vertical distance from the floor to the bust point"),
    height("waist_height", "waist height", kIso8559, false, "left_10th_rib",
           "vertical distance from the floor to the waist level, midway between lowest rib and iliac crest",
           "left_iliocristale"),
    height("iliac_crest_height", "iliac crest height", kCaesar, true, "*iliocristale",
           "vertical distance from the floor to the top of the iliac crest"),
    height("iliac_spine_height", "iliac spine height, standing", kIso7250, true, "*asis",
           "vertical distance from the floor to the anterior superior iliac spine"),
    height("trochanter_height", "trochanterion height", kIso8559, true, "*trochanterion",
           "vertical distance from the floor to the top of the greater trochanter (hip height)"),
    height("crotch_height", "crotch height (inside leg height)", kBoth, false, "crotch",
           "vertical distance from the floor to the crotch"),
    height("knee_height", "knee height", kIso8559, true, "*mid_patella",
           "vertical distance from the floor to the middle of the kneecap"),
    height("tibial_height", "tibial height", kIso7250, true, "*tibiale",
           "vertical distance from the floor to the tibiale"),
    height("ankle_height", "ankle height", kIso8559, true, "*lateral_malleolus",
           "vertical distance from the floor to the lateral malleolus"),
    DimensionSpec{"trunk_length", "trunk length", kIso8559,
                  "vertical distance from the cervicale to the crotch", false, K::vertical, "cervicale",
                  "crotch", "", R::torso, "", 0, 0},

    line("biacromial_breadth", "shoulder (biacromial) breadth", kIso7250, false, "left_acromion",
         "right_acromion", "straight distance between the acromia"),
    DimensionSpec{"shoulder_width", "shoulder width through the back neck point", kIso8559,
                  "from the left acromion over the cervicale to the right acromion, straight lines", false,
                  K::path, "left_acromion", "cervicale", "right_acromion", R::torso, "", 0, 0},
    line("shoulder_length", "shoulder length", kIso8559, true, "*neck_shoulder_point", "*acromion",
         "straight distance from the side neck point to the acromion"),
    line("bust_point_distance", "bust point to bust point", kIso8559, false, "left_thelion", "right_thelion",
         "straight distance between the bust points"),
    line("biiliac_breadth", "biiliac breadth", kCaesar, false, "left_iliocristale", "right_iliocristale",
         "straight distance between the iliac crests, soft tissue not compressed"),
    line("upper_arm_length", "upper arm length", kIso8559, true, "*acromion", "*olecranon",
         "straight distance from the acromion to the olecranon"),
    DimensionSpec{"arm_length", "arm length", kIso8559,
                  "from the acromion over the olecranon to the ulnar styloid, straight lines", true, K::path,
                  "*acromion", "*olecranon", "*ulnar_styloid", R::arm, "", 0, 0},
    line("elbow_wrist_length", "elbow-wrist length", kIso7250, true, "*olecranon", "*ulnar_styloid",
         "straight distance from the olecranon to the ulnar styloid, arm straight"),
    line("forearm_fingertip_length", "forearm-fingertip length", kIso7250, true, "*olecranon", "*dactylion",
         "straight distance from the olecranon to the tip of the middle finger, arm straight"),
    DimensionSpec{"hand_length", "hand length", kIso7250,
                  "straight distance from the middle of the styloids to the tip of the middle finger", true,
                  K::distance_middle, "*radial_styloid", "*dactylion", "*ulnar_styloid", R::arm, "", 0, 0},
    line("hand_breadth", "hand breadth at metacarpals", kIso7250, true, "*metacarpal_phalangeal_ii",
         "*metacarpal_phalangeal_v", "straight distance between the heads of the 2nd and 5th metacarpal"),
    line("elbow_breadth", "elbow breadth", kCaesar, true, "*lateral_humeral_epicondyle",
         "*medial_humeral_epicondyle", "straight distance between the humeral epicondyles"),
    line("wrist_breadth", "wrist breadth", kCaesar, true, "*radial_styloid", "*ulnar_styloid",
         "straight distance between the styloids"),
    line("knee_breadth", "knee breadth", kCaesar, true, "*lateral_femoral_epicondyle",
         "*medial_femoral_epicondyle", "straight distance between the femoral epicondyles"),
    line("ankle_breadth", "ankle breadth", kCaesar, true, "*lateral_malleolus", "*medial_malleolus",
         "straight distance between the malleoli"),
    DimensionSpec{"foot_length", "foot length", kBoth,
                  "extent of the foot along the line from the heel to the 2nd toe, seen from above", true,
                  K::foot_extent, "*calcaneus_posterior", "*digit_ii", "", R::leg, "", 0, 0},
    line("foot_breadth", "foot breadth", kBoth, true, "*metatarsal_phalangeal_i", "*metatarsal_phalangeal_v",
         "straight distance between the 1st and 5th metatarsophalangeal joints"),
    line("head_length", "head length", kIso7250, false, "glabella", "opisthocranion",
         "straight distance from the glabella to the rearmost point of the head"),
    line("head_breadth", "head breadth", kIso7250, false, "left_euryon", "right_euryon",
         "straight distance between the sides of the head above the ears"),
    line("face_length", "face length", kIso7250, false, "sellion", "menton",
         "straight distance from the sellion to the chin"),

    level(K::level_breadth, "chest_breadth", "chest breadth, standing", kIso7250, R::torso, "left_thelion",
          "right_thelion", "left-right extent of the torso at the bust points' level"),
    level(K::level_depth, "chest_depth", "chest depth, standing", kIso7250, R::torso, "left_thelion",
          "right_thelion", "front-back extent of the torso at the bust points' level"),
    level(K::level_breadth, "waist_breadth", "waist breadth", kCaesar, R::torso, "left_10th_rib",
          "left_iliocristale",
          "left-right extent at the waist level, midway between lowest rib and iliac crest"),
    level(K::level_depth, "waist_depth", "waist depth", kCaesar, R::torso, "left_10th_rib",
          "left_iliocristale", "front-back extent at the waist level"),
    level(K::widest_breadth, "hip_breadth", "hip breadth, standing", kIso7250, R::body_without_arms, "crotch",
          "left_iliocristale", "largest left-right extent of the hips between crotch and iliac crest"),

    DimensionSpec{"head_girth", "head circumference", kBoth,
                  "tape over glabella and the rearmost point of the head", false, K::tilted_girth, "glabella",
                  "opisthocranion", "", R::torso, "head", 0, 0},
    DimensionSpec{"head_sagittal_arc", "sagittal arc", kIso7250,
                  "taut tape from the glabella over the crown to the nuchale in the median plane", false,
                  K::sagittal_arc, "glabella", "nuchale", "top_of_head", R::torso, "head", 0, 0},
    DimensionSpec{"bitragion_arc", "bitragion arc", kIso7250,
                  "taut tape from tragion to tragion over the top of the head", false, K::coronal_arc,
                  "left_tragion", "right_tragion", "top_of_head", R::torso, "head", 0, 0},
    across(K::limb_narrowest, "neck_girth", "neck girth", kBoth, false, R::torso, "neck", "", "", 0.1, 0.5,
           "smallest tape across the neck's axis in the lower half of the neck, clear of jaw and shoulders"),
    DimensionSpec{
        "neck_base_girth", "neck base girth", kIso8559,
        "taut tapes from the cervicale over the left and the right side neck point to the notch of the "
        "breastbone",
        false, K::neck_base, "cervicale", "suprasternale", "*neck_shoulder_point", R::torso, "", 0, 0},
    level(K::level_girth, "upper_chest_girth", "upper chest girth", kIso8559, R::torso,
          "left_axilla_anterior", "right_axilla_anterior",
          "horizontal tape round the torso at the front axillary folds, arms left out"),
    level(K::widest_girth, "chest_girth", "chest girth", kBoth, R::torso, "substernale",
          "left_axilla_anterior",
          "largest horizontal tape round the torso between the lower end of the breastbone and the axillae, "
          "arms left out"),
    level(K::level_girth, "bust_girth", "bust girth", kIso8559, R::torso, "left_thelion", "right_thelion",
          "horizontal tape round the torso at the bust points"),
    level(K::level_girth, "under_bust_girth", "under-bust girth", kIso8559, R::torso, "left_inframammary",
          "right_inframammary", "horizontal tape round the torso just below the breasts"),
    level(K::level_girth, "waist_girth", "waist girth", kBoth, R::torso, "left_10th_rib", "left_iliocristale",
          "horizontal tape midway between lowest rib and iliac crest"),
    level(K::narrowest_girth, "waist_girth_minimum", "smallest waist girth", kNone, R::torso,
          "left_iliocristale", "left_inframammary", "smallest horizontal tape between iliac crest and bust"),
    level(K::level_girth, "waist_girth_omphalion", "waist girth at the navel", kCaesar, R::torso, "omphalion",
          "", "horizontal tape at the navel"),
    level(K::level_girth, "high_hip_girth", "high hip girth", kIso8559, R::body_without_arms, "left_asis",
          "right_asis", "horizontal tape at the anterior superior iliac spines"),
    level(K::widest_girth, "hip_girth", "hip girth", kBoth, R::body_without_arms, "crotch",
          "left_iliocristale", "largest horizontal tape round the hips between crotch and iliac crest"),
    DimensionSpec{"back_waist_length", "back waist length", kIso8559,
                  "taut tape down the back from the cervicale to the waist in the median plane", false,
                  K::sagittal_arc, "cervicale", "waist_preferred_posterior", "", R::torso, "", 0, 0},

    leg(K::level_girth, "thigh_girth", "thigh girth", kBoth, "crotch", "", "*upper_leg",
        "horizontal tape round the thigh 20 mm below the crotch"),
    leg(K::level_girth, "mid_thigh_girth", "mid-thigh girth", kIso8559, "crotch", "*mid_patella",
        "*upper_leg", "horizontal tape midway between crotch and kneecap"),
    leg(K::level_girth, "knee_girth", "knee girth", kIso8559, "*mid_patella", "", "*leg",
        "horizontal tape at the middle of the kneecap"),
    leg(K::level_girth, "lower_knee_girth", "lower knee girth", kIso8559, "*tibiale", "", "*leg",
        "horizontal tape at the tibiale"),
    leg(K::widest_girth, "calf_girth", "calf girth", kBoth, "*lateral_malleolus", "*tibiale", "*leg",
        "largest horizontal tape between ankle and knee"),
    leg(K::narrowest_girth, "minimum_leg_girth", "minimum leg girth", kIso8559, "*lateral_malleolus",
        "*tibiale", "*leg", "smallest horizontal tape between ankle and knee"),
    leg(K::level_girth, "ankle_girth", "ankle girth", kIso8559, "*lateral_malleolus", "", "",
        "horizontal tape at the lateral malleolus"),
    across(K::limb_girth, "upper_arm_girth", "upper arm girth", kIso8559, true, R::arm, "*arm", "*acromion",
           "*olecranon", 0, 0,
           "tape across the upper arm midway between acromion and olecranon, arm straight"),
    across(K::limb_girth, "elbow_girth", "elbow girth", kIso8559, true, R::arm, "*arm", "*olecranon",
           "*lateral_humeral_epicondyle", 0, 0, "tape across the straight arm at the elbow"),
    across(K::limb_widest, "forearm_girth", "forearm girth", kIso8559, true, R::arm, "*forearm", "", "", 0.1,
           0.6, "largest tape across the forearm below the elbow"),
    across(K::limb_girth, "wrist_girth", "wrist girth", kBoth, true, R::arm, "*forearm", "*radial_styloid",
           "*ulnar_styloid", 0, 0, "tape across the forearm at the styloids"),
    across(K::limb_girth, "hand_girth", "hand girth", kIso8559, true, R::arm, "*hand",
           "*metacarpal_phalangeal_ii", "*metacarpal_phalangeal_v", 0, 0,
           "tape across the hand at the heads of the metacarpals, thumb left out"),
};

}  // namespace

std::span<const DimensionSpec> dimension_specs() { return kSpecs; }

}  // namespace vitruvian
