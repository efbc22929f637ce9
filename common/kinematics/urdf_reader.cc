#include "common/kinematics/urdf_reader.h"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr double kInside_m = 1e-6;

/// The first complaint of urdfdom, instead of lines on stderr. Restores the handler that was there before.
class Complaints final : public console_bridge::OutputHandler {
 public:
  Complaints() : before_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::useOutputHandler(before_); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (first_.empty() && level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  console_bridge::OutputHandler* before_;
  std::string first_;
};

Pose ToPose(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return MakePose({pose.position.x, pose.position.y, pose.position.z}, Eigen::Quaterniond(r.w, r.x, r.y, r.z));
}

/// One file: the XML as it stands, and what urdfdom made of it.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {
    std::ifstream stream(file, std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    if (!stream) Fail(std::string("cannot be read: ") + std::strerror(errno));
    xml_.Parse(text.str().c_str());
    if (xml_.Error())
      throw ConfigError(file_.string() + ":" + std::to_string(xml_.ErrorRow()) + ": no valid XML: " + xml_.ErrorDesc());
    const TiXmlElement* robot = xml_.FirstChildElement("robot");
    if (robot == nullptr) Fail("no URDF: it has no element `robot`");
    Index(*robot, "link", links_);
    Index(*robot, "joint", joints_);
    for (const auto& [name, joint] : joints_) CheckLimits(name, *joint);
    const Complaints complaints;
    model_ = urdf::parseURDF(text.str());
    if (!model_) Fail("no valid URDF: " + complaints.first());
  }

  ArmModel Read(const std::string& base_link, const std::string& flange_link) const;

 private:
  using Elements = std::map<std::string, const TiXmlElement*>;

  [[noreturn]] void Fail(const std::string& what) const { throw ConfigError(file_.string() + ": " + what); }

  void Index(const TiXmlElement& robot, const char* kind, Elements& elements) const {
    for (const TiXmlElement* e = robot.FirstChildElement(kind); e != nullptr; e = e->NextSiblingElement(kind)) {
      const char* name = e->Attribute("name");
      if (name == nullptr) Fail(std::string("no valid URDF: a ") + kind + " has no name");
      elements[name] = e;
    }
  }

  /// urdfdom takes a lower or upper limit that is missing as 0.
  void CheckLimits(const std::string& name, const TiXmlElement& joint) const {
    const char* type = joint.Attribute("type");
    const bool revolute = type != nullptr && std::string_view(type) == "revolute";
    if (!revolute) return;
    const TiXmlElement* limit = joint.FirstChildElement("limit");
    if (limit == nullptr) Fail("joint `" + name + "` has no limits: add <limit lower= upper= velocity= effort=>");
    for (const char* key : {"lower", "upper", "velocity"}) {
      if (limit->Attribute(key) == nullptr) Fail("joint `" + name + "` has limits without `" + key + "`");
    }
  }

  urdf::LinkConstSharedPtr FindLink(const std::string& name) const {
    urdf::LinkConstSharedPtr link = model_->getLink(name);
    if (link) return link;
    std::string known;
    for (const auto& [other, element] : links_) known += (known.empty() ? "" : ", ") + other;
    Fail("there is no link `" + name + "` (there are: " + known + ")");
  }

  std::vector<urdf::JointConstSharedPtr> FindChain(const std::string& base_link, const std::string& flange_link) const;
  ArmJoint MakeJoint(const urdf::Joint& joint, const Pose& X_PJ) const;
  void AddBodies(const urdf::Link& link, const Pose& X_LG, const std::vector<std::string>& chain,
                 ArmLink& arm_link) const;
  void AddShape(const urdf::Link& link, const urdf::Collision& collision, const Pose& X_LG, ArmLink& arm_link) const;

  std::filesystem::path file_;
  TiXmlDocument xml_;
  Elements links_;
  Elements joints_;
  urdf::ModelInterfaceSharedPtr model_;
};

std::vector<urdf::JointConstSharedPtr> Reader::FindChain(const std::string& base_link,
                                                         const std::string& flange_link) const {
  const urdf::LinkConstSharedPtr base = FindLink(base_link);
  std::vector<urdf::JointConstSharedPtr> chain;
  urdf::LinkConstSharedPtr link = FindLink(flange_link);
  while (link->name != base_link) {
    if (!link->parent_joint) Fail("link `" + flange_link + "` does not hang on link `" + base_link + "`");
    chain.push_back(link->parent_joint);
    link = model_->getLink(link->parent_joint->parent_link_name);
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

ArmJoint Reader::MakeJoint(const urdf::Joint& joint, const Pose& X_PJ) const {
  const std::string name = "joint `" + joint.name + "`";
  if (joint.type != urdf::Joint::REVOLUTE && joint.type != urdf::Joint::CONTINUOUS)
    Fail(name + " does not turn: only revolute, continuous and fixed joints can be planned for");
  if (joint.mimic) Fail(name + " mimics another: the joints of the chain must move by themselves");
  if (!joint.limits || !(joint.limits->velocity > 0.0) || !std::isfinite(joint.limits->velocity))
    Fail(name + " has no speed: add velocity= to its limits, radians per second");
  ArmJoint made;
  made.name = joint.name;
  made.X_PJ = X_PJ;
  made.axis = Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(made.axis.norm() > 1e-6)) Fail(name + " has an axis of length 0");
  made.axis.normalize();
  const bool endless = joint.type == urdf::Joint::CONTINUOUS;
  made.min_rad = endless ? -2.0 * std::numbers::pi : joint.limits->lower;
  made.max_rad = endless ? 2.0 * std::numbers::pi : joint.limits->upper;
  made.max_rad_per_s = joint.limits->velocity;
  if (!(made.min_rad < made.max_rad)) Fail(name + " has a lower limit that is not below its upper limit");
  return made;
}

void Reader::AddShape(const urdf::Link& link, const urdf::Collision& collision, const Pose& X_LG,
                      ArmLink& arm_link) const {
  const Pose X_LC = X_LG * ToPose(collision.origin);
  const auto check = [&](double size) {
    if (!(size > 0.0) || !std::isfinite(size)) Fail("link `" + link.name + "` has a collision shape without size");
  };
  switch (collision.geometry->type) {
    case urdf::Geometry::SPHERE: {
      const auto& sphere = dynamic_cast<const urdf::Sphere&>(*collision.geometry);
      check(sphere.radius);
      arm_link.capsules.push_back({X_LC.translation(), X_LC.translation(), sphere.radius});
      return;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*collision.geometry);
      check(cylinder.radius);
      check(cylinder.length);
      const Eigen::Vector3d half = 0.5 * cylinder.length * Eigen::Vector3d::UnitZ();
      arm_link.capsules.push_back({X_LC * -half, X_LC * half, cylinder.radius});
      return;
    }
    case urdf::Geometry::BOX: {
      const auto& box = dynamic_cast<const urdf::Box&>(*collision.geometry);
      for (const double size : {box.dim.x, box.dim.y, box.dim.z}) check(size);
      arm_link.blocks.push_back({X_LC, 0.5 * Eigen::Vector3d(box.dim.x, box.dim.y, box.dim.z)});
      return;
    }
    default:
      Fail("link `" + link.name + "` has a mesh as collision shape: use boxes, cylinders and spheres");
  }
}

/// Adds the shapes of a link, at X_LG in the link of the chain, and of everything that hangs on it and does not move.
void Reader::AddBodies(const urdf::Link& link, const Pose& X_LG, const std::vector<std::string>& chain,
                       ArmLink& arm_link) const {
  size_t stated = 0;
  const TiXmlElement* element = links_.at(link.name);
  for (const TiXmlElement* e = element->FirstChildElement("collision"); e != nullptr;
       e = e->NextSiblingElement("collision"))
    ++stated;
  const auto is_whole = [](const urdf::CollisionSharedPtr& c) { return c && c->geometry; };
  const auto read = std::count_if(link.collision_array.begin(), link.collision_array.end(), is_whole);
  if (static_cast<size_t>(read) != stated) {
    Fail("link `" + link.name + "` has " + std::to_string(stated) + " collision shapes, of which " +
         std::to_string(stated - read) + " cannot be read: each needs a geometry with one box, cylinder or sphere");
  }
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) AddShape(link, *collision, X_LG, arm_link);
  for (const urdf::JointSharedPtr& joint : link.child_joints) {
    if (joint->type == urdf::Joint::FIXED) {
      const Pose X_LC = X_LG * ToPose(joint->parent_to_joint_origin_transform);
      AddBodies(*model_->getLink(joint->child_link_name), X_LC, chain, arm_link);
    } else if (std::find(chain.begin(), chain.end(), joint->name) == chain.end()) {
      Fail("joint `" + joint->name + "` moves but is not on the way from the base to the flange");
    }
  }
}

/// Leaves out spheres that lie in a longer capsule of the same link.
void DropInnerSpheres(std::vector<Capsule>& capsules) {
  const std::vector<Capsule> all = capsules;
  std::erase_if(capsules, [&](const Capsule& sphere) {
    if (sphere.p_A != sphere.p_B) return false;
    return std::any_of(all.begin(), all.end(), [&](const Capsule& c) {
      const Eigen::Vector3d along = c.p_B - c.p_A;
      if (along.norm() < kInside_m) return false;
      const double share = std::clamp((sphere.p_A - c.p_A).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (sphere.p_A - c.p_A - share * along).norm() + sphere.radius_m <= c.radius_m + kInside_m;
    });
  });
}

ArmModel Reader::Read(const std::string& base_link, const std::string& flange_link) const {
  const std::vector<urdf::JointConstSharedPtr> chain = FindChain(base_link, flange_link);
  std::vector<std::string> moving;
  for (const auto& joint : chain) {
    if (joint->type != urdf::Joint::FIXED) moving.push_back(joint->name);
  }
  if (moving.empty() || moving.size() > static_cast<size_t>(kMaxJoints))
    Fail("there are " + std::to_string(moving.size()) + " moving joints between `" + base_link + "` and `" +
         flange_link + "`: 1 to " + std::to_string(kMaxJoints) + " can be planned for");
  ArmModel arm;
  arm.name = model_->getName();
  ArmLink link{base_link, {}, {}};
  AddBodies(*FindLink(base_link), Pose::Identity(), moving, link);
  arm.links.push_back(link);
  for (const auto& joint : chain) {
    arm.X_LF = arm.X_LF * ToPose(joint->parent_to_joint_origin_transform);
    if (joint->type == urdf::Joint::FIXED) continue;
    arm.joints.push_back(MakeJoint(*joint, arm.X_LF));
    arm.X_LF = Pose::Identity();
    ArmLink next{joint->child_link_name, {}, {}};
    AddBodies(*FindLink(joint->child_link_name), Pose::Identity(), moving, next);
    arm.links.push_back(next);
  }
  for (ArmLink& made : arm.links) {
    if (made.capsules.empty() && made.blocks.empty()) Fail("link `" + made.name + "` has no collision body");
    DropInnerSpheres(made.capsules);
  }
  return arm;
}

}  // namespace

ArmModel ReadArm(const std::filesystem::path& file, const std::string& base_link, const std::string& flange_link) {
  return Reader(file).Read(base_link, flange_link);
}

}  // namespace nbs
