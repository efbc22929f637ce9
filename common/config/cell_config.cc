#include "common/config/cell_config.h"

#include <array>
#include <charconv>
#include <numbers>

#include "common/config/suggestion.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

using std::numbers::pi;

constexpr Range kPositive = {.min = 0.0, .above_min = true};
constexpr Range kNotNegative = {.min = 0.0};
// A stripe of more points would not fit the 60,000 bytes of one message.
constexpr int kMaxPoints = 10000;

void ReadProfiler(const StrictReader& reader, Profiler& profiler) {
  reader.Read("points", profiler.points, 2, kMaxPoints);
  reader.Read("rate_hz", profiler.rate_hz, {.min = 0.0, .max = 100000.0, .above_min = true});
  reader.Read("fan_rad", profiler.fan_rad, {.min = 0.0, .max = pi, .above_min = true, .below_max = true});
  reader.Read("min_depth_m", profiler.min_depth_m, kPositive);
  reader.Read("max_depth_m", profiler.max_depth_m, kPositive);
  reader.Read("standoff_m", profiler.standoff_m, kPositive);
  reader.Read("sigma_base_m", profiler.sigma_base_m, kNotNegative);
  reader.Read("sigma_per_m", profiler.sigma_per_m, kNotNegative);
  reader.Read("max_incidence_rad", profiler.max_incidence_rad, {.min = 0.0, .max = pi / 2, .above_min = true});
  reader.Read("camera_baseline_m", profiler.camera_baseline_m, kNotNegative);
  reader.Read("scan_speed_m_per_s", profiler.scan_speed_m_per_s, kPositive);
  if (profiler.max_depth_m <= profiler.min_depth_m) {
    reader.Fail("max_depth_m", "`max_depth_m` (" + FormatNumber(profiler.max_depth_m) +
                                   ") must be above `min_depth_m` (" + FormatNumber(profiler.min_depth_m) + ")");
  }
  if (profiler.standoff_m < profiler.min_depth_m || profiler.standoff_m > profiler.max_depth_m) {
    reader.Fail("standoff_m", "`standoff_m` (" + FormatNumber(profiler.standoff_m) +
                                  ") must lie in the depth of field, " + FormatNumber(profiler.min_depth_m) + " to " +
                                  FormatNumber(profiler.max_depth_m));
  }
}

void ReadBody(const StrictReader& reader, StrictReader::Missing missing, std::vector<Sphere>& body_S) {
  const YamlTree* list = reader.Find("sensor_body_S");
  if (!list) return;
  if (list->kind != YamlTree::Kind::kList) reader.Fail("sensor_body_S", "`sensor_body_S` must be a list of spheres");
  if (list->items.empty()) {
    reader.Fail("sensor_body_S",
                "`sensor_body_S` needs at least one sphere: without a body nothing keeps the profiler "
                "from touching the object");
  }
  body_S.clear();
  for (const YamlTree& item : list->items) {
    const StrictReader sphere_reader = reader.Inner(item, {"center_m", "radius_m"}, missing);
    Sphere sphere;
    sphere_reader.Read("center_m", sphere.center);
    sphere_reader.Read("radius_m", sphere.radius_m, kPositive);
    if (sphere.radius_m <= 0.0) sphere_reader.Fail("radius_m", "key `radius_m` is missing");
    body_S.push_back(sphere);
  }
}

void ReadOptional(const StrictReader& reader, std::string_view key, std::optional<double>& value) {
  if (!reader.Find(key)) return;
  double number = 0.0;
  reader.Read(key, number, Range{});
  value = number;
}

void ReadTable(const StrictReader& reader, CellConfig& cell) {
  ReadOptional(reader, "table_z_m", cell.table_z_m);
  ReadOptional(reader, "table_above_object_m", cell.table_above_object_m);
  reader.Read("table_half_m", cell.table_half_m);
  if (!(cell.table_half_m.minCoeff() > 0.0)) reader.Fail("table_half_m", "`table_half_m` must be two sizes above 0");
}

void ReadArmOf(const std::filesystem::path& file, const StrictReader& reader, ArmConfig& arm) {
  static constexpr std::array<std::string_view, 2> kMethods = {"analytic", "numeric"};
  static constexpr std::array<std::string_view, 2> kSearches = {"rrt_connect", "prm"};
  static constexpr std::array<std::string_view, 2> kRegistrations = {"none", "joint"};
  std::string urdf;
  reader.Read("urdf", urdf);
  if (urdf.empty()) reader.Fail("urdf", "an arm needs `urdf`, the name of its URDF file");
  arm.urdf = std::filesystem::absolute(file.parent_path() / urdf).lexically_normal();
  reader.Read("base_link", arm.base_link);
  reader.Read("flange_link", arm.flange_link);
  reader.ReadChoice("inverse_kinematics", "inverse kinematics", kMethods, arm.inverse_kinematics);
  reader.ReadChoice("motion_search", "motion search", kSearches, arm.motion_search);
  reader.ReadChoice("registration", "registration", kRegistrations, arm.registration);
  reader.Read("X_OB", arm.X_OB);
  reader.Read("start_rad", arm.start_rad);
  reader.Read("max_rad_per_s2", arm.max_rad_per_s2);
  for (const double limit : arm.max_rad_per_s2) {
    if (!(limit > 0.0)) reader.Fail("max_rad_per_s2", "`max_rad_per_s2` must hold accelerations above 0");
  }
  if (arm.start_rad.empty() || arm.start_rad.size() != arm.max_rad_per_s2.size())
    reader.Fail("start_rad", "`start_rad` and `max_rad_per_s2` must have a number for each joint");
  reader.Read("pose_bias_m", arm.pose_bias_m, kNotNegative);
  reader.Read("pose_noise_m", arm.pose_noise_m, kNotNegative);
}

void ReadRobot(const std::filesystem::path& file, const StrictReader& reader, StrictReader::Missing missing,
               CellConfig& cell) {
  static constexpr std::array<std::string_view, 2> kRobots = {"free", "arm"};
  reader.ReadChoice("robot", "robot", kRobots, cell.robot);
  const YamlTree* arm = reader.Find("arm");
  if (cell.robot == "free") {
    if (arm) reader.Fail("arm", "`arm` needs `robot: arm`");
    return;
  }
  if (!arm) reader.Fail("arm", "the robot is an arm, but `arm` is missing");
  ReadArmOf(file,
            reader.Inner(*arm,
                         {"urdf", "base_link", "flange_link", "inverse_kinematics", "motion_search", "registration",
                          "X_OB", "start_rad", "max_rad_per_s2", "pose_bias_m", "pose_noise_m"},
                         missing),
            cell.arm.emplace());
}

void ReadFirstPath(const StrictReader& reader, CellConfig& cell) {
  reader.Read("first_view_W", cell.first_view_W);
  reader.Read("first_along_W", cell.first_along_W);
  reader.Read("first_standoff_m", cell.first_standoff_m, kPositive);
  reader.Read("first_above_table_m", cell.first_above_table_m, kNotNegative);
  constexpr double kShortest = 1e-9;
  if (cell.first_view_W.norm() < kShortest) reader.Fail("first_view_W", "`first_view_W` must not be zero");
  if (cell.first_along_W.norm() < kShortest) reader.Fail("first_along_W", "`first_along_W` must not be zero");
  constexpr double kSmallestSine = 1e-3;
  if (cell.first_view_W.normalized().cross(cell.first_along_W.normalized()).norm() < kSmallestSine) {
    reader.Fail(
        "first_along_W",
        "`first_along_W` must not be parallel to `first_view_W`: the sensor moves across its viewing direction");
  }
}

}  // namespace

std::vector<Sphere> MakeDefaultSensorBody() {
  constexpr double kRadius = 0.049;
  std::vector<Sphere> spheres_S;
  for (const double y : {-0.074, -0.024, 0.024, 0.074}) {
    for (const double x : {-0.028, 0.028}) spheres_S.push_back({{x, y, -0.05}, kRadius});
  }
  return spheres_S;
}

CellConfig ReadCell(const std::filesystem::path& file, const YamlTree& tree, StrictReader::Missing missing) {
  const StrictReader reader(
      file, tree,
      {"name", "robot", "arm", "profiler", "X_FS", "sensor_body_S", "body_margin_m", "move_speed_m_per_s",
       "turn_speed_rad_per_s", "resolution_m", "unknown_margin_m", "table_z_m", "table_above_object_m", "table_half_m",
       "first_view_W", "first_along_W", "first_standoff_m", "first_above_table_m"},
      missing);
  CellConfig cell;
  reader.Read("name", cell.name);
  ReadRobot(file, reader, missing, cell);
  if (const YamlTree* profiler = reader.Find("profiler")) {
    ReadProfiler(
        reader.Inner(*profiler,
                     {"points", "rate_hz", "fan_rad", "min_depth_m", "max_depth_m", "standoff_m", "sigma_base_m",
                      "sigma_per_m", "max_incidence_rad", "camera_baseline_m", "scan_speed_m_per_s"},
                     missing),
        cell.profiler);
  }
  reader.Read("X_FS", cell.X_FS);
  ReadBody(reader, missing, cell.sensor_body_S);
  reader.Read("body_margin_m", cell.body_margin_m, kNotNegative);
  reader.Read("move_speed_m_per_s", cell.move_speed_m_per_s, kPositive);
  reader.Read("turn_speed_rad_per_s", cell.turn_speed_rad_per_s, kPositive);
  reader.Read("resolution_m", cell.resolution_m, {.min = 0.0005, .max = 0.5});
  reader.Read("unknown_margin_m", cell.unknown_margin_m, kNotNegative);
  ReadTable(reader, cell);
  ReadFirstPath(reader, cell);
  return cell;
}

CellConfig ReadCellConfig(const std::filesystem::path& file) {
  return ReadCell(file, ReadYamlTree(file), StrictReader::Missing::kKeepsDefault);
}

std::string FormatNumber(double value) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return std::string(text.data(), end);
}

std::string FormatVector(const Eigen::Vector3d& value) {
  std::string text;
  for (int i = 0; i < 3; ++i) text.append(i == 0 ? "[" : ", ").append(FormatNumber(value[i]));
  return text.append("]");
}

std::string FormatPose(const Pose& X) {
  std::string text = "{position_m: " + FormatVector(X.translation()) + ", rotation: [";
  for (int i = 0; i < 9; ++i) text += (i > 0 ? ", " : "") + FormatNumber(X.linear()(i / 3, i % 3));
  return text + "]}";
}

namespace {

std::string FormatList(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + FormatNumber(value);
  return text + "]";
}

std::string FormatOptional(const std::optional<double>& value) { return value ? FormatNumber(*value) : "null"; }

std::string FormatArm(const std::optional<ArmConfig>& arm, const std::string& indent) {
  if (!arm) return indent + "arm: null\n";
  std::string text = indent + "arm:\n";
  const auto add = [&](const std::string& key, const std::string& value) {
    text += indent + "  " + key + ": " + value + "\n";
  };
  add("urdf", QuoteYaml(arm->urdf.string()));
  add("base_link", QuoteYaml(arm->base_link));
  add("flange_link", QuoteYaml(arm->flange_link));
  add("inverse_kinematics", arm->inverse_kinematics);
  add("motion_search", arm->motion_search);
  add("registration", arm->registration);
  add("X_OB", FormatPose(arm->X_OB));
  add("start_rad", FormatList(arm->start_rad));
  add("max_rad_per_s2", FormatList(arm->max_rad_per_s2));
  add("pose_bias_m", FormatNumber(arm->pose_bias_m));
  add("pose_noise_m", FormatNumber(arm->pose_noise_m));
  return text;
}

}  // namespace

std::string FormatCell(const CellConfig& cell, const std::string& indent) {
  std::string text;
  const auto add = [&](const std::string& key, const std::string& value) {
    text += indent + key + ": " + value + "\n";
  };
  add("name", QuoteYaml(cell.name));
  add("robot", QuoteYaml(cell.robot));
  text += FormatArm(cell.arm, indent);
  text += indent + "profiler:\n";
  const Profiler& profiler = cell.profiler;
  add("  points", std::to_string(profiler.points));
  add("  rate_hz", FormatNumber(profiler.rate_hz));
  add("  fan_rad", FormatNumber(profiler.fan_rad));
  add("  min_depth_m", FormatNumber(profiler.min_depth_m));
  add("  max_depth_m", FormatNumber(profiler.max_depth_m));
  add("  standoff_m", FormatNumber(profiler.standoff_m));
  add("  sigma_base_m", FormatNumber(profiler.sigma_base_m));
  add("  sigma_per_m", FormatNumber(profiler.sigma_per_m));
  add("  max_incidence_rad", FormatNumber(profiler.max_incidence_rad));
  add("  camera_baseline_m", FormatNumber(profiler.camera_baseline_m));
  add("  scan_speed_m_per_s", FormatNumber(profiler.scan_speed_m_per_s));
  add("X_FS", FormatPose(cell.X_FS));
  text += indent + "sensor_body_S:\n";
  for (const Sphere& sphere : cell.sensor_body_S) {
    text += indent + "  - {center_m: " + FormatVector(sphere.center) + ", radius_m: " + FormatNumber(sphere.radius_m) +
            "}\n";
  }
  add("body_margin_m", FormatNumber(cell.body_margin_m));
  add("move_speed_m_per_s", FormatNumber(cell.move_speed_m_per_s));
  add("turn_speed_rad_per_s", FormatNumber(cell.turn_speed_rad_per_s));
  add("resolution_m", FormatNumber(cell.resolution_m));
  add("unknown_margin_m", FormatNumber(cell.unknown_margin_m));
  add("table_z_m", FormatOptional(cell.table_z_m));
  add("table_above_object_m", FormatOptional(cell.table_above_object_m));
  add("table_half_m", FormatList({cell.table_half_m.x(), cell.table_half_m.y()}));
  add("first_view_W", FormatVector(cell.first_view_W));
  add("first_along_W", FormatVector(cell.first_along_W));
  add("first_standoff_m", FormatNumber(cell.first_standoff_m));
  add("first_above_table_m", FormatNumber(cell.first_above_table_m));
  return text;
}

}  // namespace nbs
