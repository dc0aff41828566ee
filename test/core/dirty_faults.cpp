#include "dirty_faults.h"

namespace virtual_work_dynamics {
namespace dirty {

const std::vector<NamedFault>& inertialFaults() {
  static const std::vector<NamedFault> faults = {
      {"no inertial", Verdict::kAccept, [](Robot& r, Dice& d) { bodyOf(r, d).inertial.clear(); }},
      {"no mass at all", Verdict::kAccept,
       [](Robot& r, Dice&) {
         for (LinkText& link : r.links) link.inertial.clear();
       }},
      {"mass 0", Verdict::kAccept, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "0"); }},
      {"mass 1e-300", Verdict::kAccept, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "1e-300"); }},
      {"negative mass", Verdict::kRefuse, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "-1"); }},
      {"mass nan", Verdict::kRefuse, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "nan"); }},
      {"mass inf", Verdict::kRefuse, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "inf"); }},
      {"mass 1e999", Verdict::kRefuse, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "1e999"); }},
      {"mass with a comma", Verdict::kRefuse,
       [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "1,5"); }},
      {"mass with a unit", Verdict::kRefuse,
       [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "1.5 kg"); }},
      {"mass with blanks", Verdict::kAccept,
       [](Robot& r, Dice& d) { setMass(bodyOf(r, d), " 1.5\n "); }},
      {"mass empty", Verdict::kRefuse, [](Robot& r, Dice& d) { setMass(bodyOf(r, d), ""); }},
      {"mass huge text", Verdict::kRefuse,
       [](Robot& r, Dice& d) { setMass(bodyOf(r, d), std::string(200000, '7') + "x"); }},
      {"mass in g", Verdict::kAccept,
       [](Robot& r, Dice&) {
         for (LinkText& link : r.links) setMass(link, "1500");
       }},
      {"inertia in g mm^2", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         LinkText& link = bodyOf(r, d);
         for (const char* name : {"ixx", "iyy", "izz"}) setMoment(link, name, "114670.25");
       }},
      {"centre of mass in mm", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         bodyOf(r, d).inertial = inertial(1, 0.1, 0.1, 0.1, "0.5 120.25 -3");
       }},
      {"triangle inequality", Verdict::kAccept,
       [](Robot& r, Dice& d) { setMoment(bodyOf(r, d), "ixx", "77"); }},
      {"inertia absurd", Verdict::kAccept,
       [](Robot& r, Dice& d) { setMoment(bodyOf(r, d), "izz", "1e200"); }},
      {"inertia nan", Verdict::kRefuse,
       [](Robot& r, Dice& d) { setMoment(bodyOf(r, d), "iyy", "NaN"); }},
      {"inertia without ixy", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         LinkText& link = bodyOf(r, d);
         link.inertial = inertial(1, 0.1, 0.1, 0.1, "0 0 0");
         replace(link.inertial, " ixy=\"0\"", "");
       }},
      {"inertial without inertia", Verdict::kRefuse,
       [](Robot& r, Dice& d) { bodyOf(r, d).inertial = "<inertial><mass value='1'/></inertial>"; }},
      {"inertial empty", Verdict::kRefuse,
       [](Robot& r, Dice& d) { bodyOf(r, d).inertial = "<inertial/>"; }},
      {"two inertials", Verdict::kAccept,
       [](Robot& r, Dice& d) { bodyOf(r, d).more += inertial(1, 0.1, 0.1, 0.1, "0 0 0"); }},
      {"mass outside inertial", Verdict::kAccept,
       [](Robot& r, Dice& d) { bodyOf(r, d).more += "<mass value=\"2\"/>"; }},
      {"inertial of SDF", Verdict::kRefuse, [](Robot& r, Dice& d) {
         bodyOf(r, d).inertial =
             "<inertial><mass>1</mass><inertia><ixx>1</ixx></inertia><pose>0 0 0</pose></inertial>";
       }}};
  return faults;
}

const std::vector<NamedFault>& jointFaults() {
  static const std::vector<NamedFault> faults = {
      {"type spherical", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).type = "spherical"; }},
      {"type Revolute", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).type = "Revolute"; }},
      {"type empty", Verdict::kRefuse, [](Robot& r, Dice& d) { d.one(r.joints).type = ""; }},
      {"type cylindrical", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).type = "cylindrical"; }},
      {"parent misspelt", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).parent += "k"; }},
      {"parent empty", Verdict::kRefuse, [](Robot& r, Dice& d) { d.one(r.joints).parent = ""; }},
      {"parent of SDF", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         const std::string name = r.joints.back().parent;
         const auto before = r.finish;
         r.finish = [=](std::string text) {
           const std::size_t at = text.rfind("<parent link=\"" + name + "\"/>");
           text.replace(at, name.size() + 17, "<parent>" + name + "</parent>");
           return before(text);
         };
       }},
      {"cycle", Verdict::kRefuse,
       [](Robot& r, Dice&) { r.joints.front().parent = r.links.back().name; }},
      {"link its own parent", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         joint.parent = joint.child;
       }},
      {"two roots", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         r.links.push_back({"spare_part", "", "", ""});
       }},
      {"two parents", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         JointText second = r.joints.back();
         second.name = "second";
         r.joints.push_back(second);
       }},
      {"joint twice", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         r.joints.push_back(r.joints.back());
         r.joints.back().child = "spare_part";
         r.links.push_back({"spare_part", "", "", ""});
       }},
      {"link twice", Verdict::kRefuse, [](Robot& r, Dice&) { r.links.push_back(r.links.back()); }},
      {"axis zero", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.axis = "<axis xyz=\"0 0 0\"/>";
       }},
      {"axis of two", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.axis = "<axis xyz=\"0 1\"/>";
       }},
      {"axis of SDF", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.axis = "<axis><xyz>0 0 1</xyz></axis>";
       }},
      {"axis not of unit length", Verdict::kAccept,
       [](Robot& r, Dice& d) { d.one(r.joints).axis = "<axis xyz=\"0 0 5\"/>"; }},
      {"no axis", Verdict::kAccept, [](Robot& r, Dice& d) { d.one(r.joints).axis = ""; }},
      {"no limit", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.limit = "";
       }},
      {"limit in degrees", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.limit = "<limit lower=\"-170\" upper=\"170\" effort=\"1\" velocity=\"1\"/>";
       }},
      {"limit without effort", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.limit = "<limit lower=\"-1\" upper=\"1\" velocity=\"1\"/>";
       }},
      {"limits reversed", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         d.one(r.joints).limit = "<limit lower=\"2\" upper=\"-2\" effort=\"0\" velocity=\"0\"/>";
       }},
      {"rpy in degrees", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         d.one(r.joints).origin = "<origin xyz=\"0 0 0.2\" rpy=\"0 90 0\"/>";
       }},
      {"origin in mm", Verdict::kAccept,
       [](Robot& r, Dice& d) { d.one(r.joints).origin = "<origin xyz=\"0 0 325.5\"/>"; }},
      {"origin with commas", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).origin = "<origin xyz=\"0,1 0,2 0,3\"/>"; }},
      {"origin of four", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).origin = "<origin xyz=\"0 0 0 1\"/>"; }},
      {"origin with line ends", Verdict::kAccept,
       [](Robot& r, Dice& d) { d.one(r.joints).origin = "<origin xyz=\"\n 0\t0\n 0.1 \"/>"; }},
      {"origin inf", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).origin = "<origin xyz=\"0 inf 0\"/>"; }},
      {"mimic chain", Verdict::kAccept,
       [](Robot& r, Dice&) {
         for (std::size_t i = 0; i < r.joints.size(); ++i) {
           makeRevolute(r.joints[i]);
           if (i > 0) {
             r.joints[i].more +=
                 "<mimic joint=\"" + r.joints[i - 1].name + "\" multiplier=\"-1\"/>";
           }
         }
       }},
      {"mimic cycle", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.more += "<mimic joint=\"" + joint.name + "\"/>";
       }},
      {"mimic of nobody", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         JointText& joint = d.one(r.joints);
         makeRevolute(joint);
         joint.more += "<mimic joint=\"finger_joint\"/>";
       }},
      {"mimic without a joint", Verdict::kRefuse,
       [](Robot& r, Dice& d) { d.one(r.joints).more += "<mimic multiplier=\"1\"/>"; }},
      {"mimic misspelt", Verdict::kAccept,
       [](Robot& r, Dice& d) { d.one(r.joints).more += "<mimmic joint=\"x\"/>"; }},
      {"dynamics empty", Verdict::kAccept,
       [](Robot& r, Dice& d) { d.one(r.joints).more += "<dynamics/>"; }},
      {"safety controller broken", Verdict::kAccept,
       [](Robot& r, Dice& d) { d.one(r.joints).more += "<safety_controller k_position=\"x\"/>"; }},
      {"joint without a child", Verdict::kRefuse, [](Robot& r, Dice&) {
         r.more += "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/></joint>";
       }}};
  return faults;
}

}  // namespace dirty
}  // namespace virtual_work_dynamics
