#include "dirty_faults.h"

namespace virtual_work_dynamics {
namespace dirty {

const std::vector<NamedFault>& textFaults() {
  static const std::vector<NamedFault> faults = {
      {"bad meshes", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         const std::string shapes[] = {"<capsule radius=\"1\"/>",
                                       "<mesh/>",
                                       "<mesh filename=\"\" scale=\"1 1\"/>",
                                       "<box size=\"a b c\"/>",
                                       "<sphere radius=\"\"/>",
                                       "<cylinder/>",
                                       "",
                                       "<octomap/>"};
         for (LinkText& link : r.links) {
           link.visual = "<visual><origin rpy=\"x\"/><geometry>" + shapes[d.below(8)] +
                         "</geometry><material/></visual><collision/>";
         }
       }},
      {"material undefined", Verdict::kAccept,
       [](Robot& r, Dice&) {
         r.more += "<material name=\"a\"/><material/><material name=\"a\"/>";
       }},
      {"transmissions", Verdict::kAccept,
       [](Robot& r, Dice&) {
         r.more += "<transmission name=\"t\"><type>differential</type><joint name=\"" +
                   r.joints.front().name + "\"/><joint name=\"b\n\"/><actuator name=\"m\"/>" +
                   "</transmission><transmission/>";
       }},
      {"gazebo", Verdict::kAccept,
       [](Robot& r, Dice&) {
         r.more +=
             "<gazebo><joint name=\"k\" type=\"revolute\"><parent>a</parent><child>b</child>"
             "</joint><plugin name=\"p\" filename=\"x.so\"><joint>a</joint><mimicJoint>b"
             "</mimicJoint></plugin></gazebo><gazebo reference=\"x\"><material>Gazebo/Blue"
             "</material><springStiffness>12</springStiffness></gazebo><gazebo/>";
       }},
      {"loop joints", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         const std::size_t count = d.below(4) == 0 ? 2000 : 2;
         for (std::size_t i = 0; i < count; ++i) {
           r.more +=
               "<loop_joint name=\"l\" type=\"ball\"><link1 link=\"a\" xyz=\"0 x 0\"/>"
               "</loop_joint><constraint/>";
         }
       }},
      {"xacro definitions", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         r.attributes += " xmlns:xacro=\"http://www.ros.org/wiki/xacro\"";
         r.more += "<xacro:property name=\"pi\" value=\"3.14\"/>";
       }},
      {"xacro call left", Verdict::kAccept,
       [](Robot& r, Dice&) { r.more += "<xacro:gripper prefix=\"${prefix}\"/>"; }},
      {"xacro name left", Verdict::kRefuse,
       [](Robot& r, Dice& d) { rename(r, d.below(r.links.size()), "${prefix}tool0"); }},
      {"xacro number left", Verdict::kRefuse,
       [](Robot& r, Dice& d) { setMass(bodyOf(r, d), "${mass_of_link * 2}"); }},
      {"unknown elements", Verdict::kAccept,
       [](Robot& r, Dice&) {
         r.more +=
             "<Link name=\"x\"/><group><link name=\"y\"/></group><drake:joint/>"
             "<sensor name=\"s\"/><joints/><verification>text &amp; more</verification>";
       }},
      {"unicode names", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         rename(r, d.below(r.links.size()),
                "H\xc3\xbc"
                "fte_\xe5\x8f\xb3");
       }},
      {"names that are not UTF-8", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         rename(r, d.below(r.links.size()),
                "H\xfc"
                "fte");
       }},
      {"control characters", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         rename(r, d.below(r.links.size()), "a&#10;b\x1b[31m\x07&#9;\xe2\x80\xae");
         setMass(bodyOf(r, d), "0");
         r.joints.back().axis = "<axis xyz=\"0 0 2\"/>";
       }},
      {"long names", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         rename(r, d.below(r.links.size()), std::string(50000, 'n'));
         d.one(r.joints).name = std::string(70000, 'm');
       }},
      {"names with markup", Verdict::kAccept,
       [](Robot& r, Dice& d) {
         rename(r, d.below(r.links.size()), "a&lt;b&gt;&quot;&apos;%s%n,");
       }},
      {"name empty", Verdict::kRefuse,
       [](Robot& r, Dice& d) { rename(r, d.below(r.links.size()), ""); }},
      {"byte order mark", Verdict::kAccept,
       [](Robot& r, Dice&) { r.start = "\xef\xbb\xbf" + r.start; }},
      {"comments", Verdict::kAccept,
       [](Robot& r, Dice&) { r.start += "<!-- made by\n hand: <link> & more -->\n\n"; }},
      {"declaration of Latin-1", Verdict::kAccept,
       [](Robot& r, Dice&) { r.start = "<?xml version='1.0' encoding='ISO-8859-1'?>\n"; }},
      {"version 2.0", Verdict::kRefuse,
       [](Robot& r, Dice&) { r.attributes += " version=\"2.0\""; }},
      {"no robot name", Verdict::kRefuse, [](Robot& r, Dice&) { r.attributes = ""; }},
      {"root element of SDF", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         const auto before = r.finish;
         r.finish = [=](const std::string& text) {
           return before(replacedAll(replacedAll(text, "<robot", "<sdf"), "</robot", "</sdf"));
         };
       }},
      {"cut off", Verdict::kRefuse,
       [](Robot& r, Dice& d) {
         const double share = d.number(0.2, 0.95);
         const auto before = r.finish;
         r.finish = [=](const std::string& text) {
           const std::string whole = before(text);
           return whole.substr(0,
                               static_cast<std::size_t>(share * static_cast<double>(whole.size())));
         };
       }},
      {"end tag missing", Verdict::kRefuse,
       [](Robot& r, Dice&) {
         const auto before = r.finish;
         r.finish = [=](std::string text) {
           replace(text, "</joint>", "");
           return before(text);
         };
       }},
      {"attribute twice", Verdict::kEither,
       [](Robot& r, Dice&) { r.attributes += " name=\"again\""; }},
      {"ampersand", Verdict::kEither,
       [](Robot& r, Dice& d) { rename(r, d.below(r.links.size()), "nuts & bolts"); }},
      {"nested deeply", Verdict::kEither,
       [](Robot& r, Dice&) {
         for (int i = 0; i < 5000; ++i) r.more += "<a>";
         for (int i = 0; i < 5000; ++i) r.more += "</a>";
       }},
      {"NUL", Verdict::kEither, [](Robot& r, Dice&) { r.more += std::string(3, '\0'); }}};
  return faults;
}

}  // namespace dirty
}  // namespace virtual_work_dynamics
