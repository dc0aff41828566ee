#include <mujoco/mujoco.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "contenders/offers.h"
#include "contenders/peer_input.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

namespace fs = std::filesystem;

using Quaternionl = Eigen::Quaternion<long double>;

// A folder that is gone when this is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "work_precision_XXXXXX").string();
    if (mkdtemp(&name[0]) == nullptr) throw FileError(name + ": cannot be made");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// A mechanism without fixed joints as MJCF. MuJoCo nests the elements of bodies, and its XML reader
// refuses deep nesting, so every few levels go into a file of their own that the one before
// includes.
class MjcfWriter {
 public:
  MjcfWriter(const Mechanism& mechanism, const fs::path& folder)
      : mechanism_(mechanism), folder_(folder), children_(mechanism.links().size()) {
    for (const Joint& joint : mechanism.joints()) {
      children_[joint.parent_link].push_back(joint.child_link);
    }
  }

  /// @returns the file to load.
  fs::path write(const Eigen::Vector3d& gravity) {
    std::ostringstream text;
    text.precision(17);
    text << "<mujoco>\n<compiler angle=\"radian\"/>\n<option gravity=\"" << gravity.x() << ' '
         << gravity.y() << ' ' << gravity.z() << "\"/>\n<worldbody>\n";
    for (const int link : children_[0]) writeBody(text, link, 1);
    text << "</worldbody>\n</mujoco>\n";
    return writeFile("model.xml", text.str());
  }

 private:
  static constexpr int kLevelsInFile = 40;

  void writeBody(std::ostringstream& text, int link, int level) {
    if (level % kLevelsInFile == 0) {
      std::ostringstream part;
      part.precision(17);
      part << "<mujocoinclude>\n";
      writeBodyHere(part, link, level);
      part << "</mujocoinclude>\n";
      const std::string name = "link_" + std::to_string(link) + ".xml";
      writeFile(name, part.str());
      text << "<include file=\"" << name << "\"/>\n";
    } else {
      writeBodyHere(text, link, level);
    }
  }

  void writeBodyHere(std::ostringstream& text, int link, int level) {
    const Joint& joint = mechanism_.joints()[link - 1];
    const Quaternionl turn(joint.R_PK);
    const Vector3l& p = joint.p_PoKo_P;
    const Vector3l& axis = joint.axis_K;
    // Mass and inertia are set in the model: the reader refuses some that can be computed with.
    text << "<body pos=\"" << p.x() << ' ' << p.y() << ' ' << p.z() << "\" quat=\"" << turn.w()
         << ' ' << turn.x() << ' ' << turn.y() << ' ' << turn.z()
         << "\"><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/><joint type=\""
         << (joint.type == JointType::kPrismatic ? "slide" : "hinge") << "\" axis=\"" << axis.x()
         << ' ' << axis.y() << ' ' << axis.z() << "\"/>\n";
    for (const int child : children_[link]) writeBody(text, child, level + 1);
    text << "</body>\n";
  }

  fs::path writeFile(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / name;
    std::ofstream file(path);
    if (!(file << text << std::flush)) throw FileError(path.string() + ": cannot be written");
    return path;
  }

  const Mechanism& mechanism_;
  const fs::path& folder_;
  std::vector<std::vector<int>> children_;
};

// Body i of the model is link i of the mechanism: both are in depth-first order.
void setInertias(const Mechanism& mechanism, mjModel& model) {
  for (int i = 1; i < model.nbody; ++i) {
    const Link& link = mechanism.links()[i];
    const Eigen::SelfAdjointEigenSolver<Matrix3l> principal(link.inertia_Cm_K);
    Matrix3l axes = principal.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
    const Quaternionl turn(axes);
    model.body_mass[i] = static_cast<double>(link.mass);
    model.body_sameframe[i] = 0;  // the inertial frame is not the body's any more
    model.body_iquat[4 * i] = static_cast<double>(turn.w());
    for (int j = 0; j < 3; ++j) {
      model.body_ipos[3 * i + j] = static_cast<double>(link.p_KoCm_K[j]);
      model.body_inertia[3 * i + j] = static_cast<double>(principal.eigenvalues()[j]);
      model.body_iquat[4 * i + 1 + j] = static_cast<double>(turn.vec()[j]);
    }
  }
  for (int i = 0; i < model.nbody; ++i) model.body_subtreemass[i] = model.body_mass[i];
  for (int i = model.nbody - 1; i > 0; --i) {
    model.body_subtreemass[model.body_parentid[i]] += model.body_subtreemass[i];
  }
}

using Model = std::shared_ptr<const mjModel>;

Model loadModel(const Mechanism& mechanism, const Eigen::Vector3d& gravity) {
  const TemporaryFolder folder;
  const fs::path file = MjcfWriter(mechanism, folder.path()).write(gravity);
  char reason[500] = "";
  const std::shared_ptr<mjModel> model(
      mj_loadXML(file.string().c_str(), nullptr, reason, sizeof(reason)), mj_deleteModel);
  if (!model) throw Error(std::string("MuJoCo: ") + reason);
  if (model->nbody != static_cast<int>(mechanism.links().size())) {
    throw Error("MuJoCo made " + std::to_string(model->nbody) + " bodies of " +
                std::to_string(mechanism.links().size()) + " links");
  }
  setInertias(mechanism, *model);
  return model;
}

// The stages of mj_inverse that inverse dynamics needs, without contacts, constraints, sensors and
// actuators. With reactions, efforts are taken from those as mj_rne() would, which spares calling
// it too. Reactions stay where MuJoCo puts them: root axes, about a common centre of mass.
class MujocoContender : public Contender {
 public:
  MujocoContender(const BenchmarkScene& scene, const std::string& outputs, const Model& model)
      : mechanism_(withoutFixedJoints(scene.mechanism)),
        movable_(movableJoints(mechanism_)),
        states_(jointMotions(mechanism_, scene.motions, movable_)),
        reactions_(outputs == kEffortsAndReactions),
        model_(model),
        data_(mj_makeData(model_.get()), mj_deleteData),
        efforts_(static_cast<Eigen::Index>(movable_.size())) {
    if (!data_) throw Error("MuJoCo: no memory");
  }

  void run(std::size_t calls) override {
    const mjModel* model = model_.get();
    mjData* data = data_.get();
    for (; calls > 0; --calls) {
      const Motion& state = states_[cycle_.next()];
      mju_copy(data->qpos, state.q.data(), model->nq);
      mju_copy(data->qvel, state.qd.data(), model->nv);
      mju_copy(data->qacc, state.qdd.data(), model->nv);
      mj_kinematics(model, data);
      mj_comPos(model, data);
      mj_comVel(model, data);
      if (reactions_) {
        mj_rnePostConstraint(model, data);
        for (int i = 0; i < model->nv; ++i) {
          const mjtNum* wrench = data->cfrc_int + 6 * model->dof_bodyid[i];
          efforts_[i] = mju_dot(data->cdof + 6 * i, wrench, 6);
        }
      } else {
        mj_rne(model, data, 1, efforts_.data());
      }
    }
  }

  SampleResults results(std::size_t) const override {
    SampleResults results{coordinateEfforts(mechanism_, movable_, efforts_), {}};
    if (!reactions_) return results;
    using ConstVector = Eigen::Map<const Eigen::Vector3d>;
    using ConstMatrix = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
    for (int i = 1; i < model_->nbody; ++i) {
      const ConstVector moment_C(data_->cfrc_int + 6 * i), force(data_->cfrc_int + 6 * i + 3);
      const ConstVector C(data_->subtree_com + 3 * model_->body_rootid[i]);
      const ConstVector O(data_->xpos + 3 * i);
      const ConstMatrix R_0K(data_->xmat + 9 * i);
      const Eigen::Vector3d moment_O = moment_C - (O - C).cross(force);
      for (const Eigen::Vector3d& part : {Eigen::Vector3d(R_0K.transpose() * force),
                                          Eigen::Vector3d(R_0K.transpose() * moment_O)}) {
        results.reactions.insert(results.reactions.end(), part.data(), part.data() + 3);
      }
    }
    return results;
  }

 private:
  Mechanism mechanism_;
  std::vector<int> movable_;
  std::vector<Motion> states_;
  bool reactions_;
  Model model_;
  std::unique_ptr<mjData, decltype(&mj_deleteData)> data_;
  Eigen::VectorXd efforts_;
  StateCycle cycle_;
};

}  // namespace

void offerMujoco(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  const auto model = std::make_shared<Model>();  // loading takes seconds for long chains: once
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    const Label label{"mujoco", "double", "single", outputs, 1};
    offers.push_back({label, [&scene, outputs, model] {
                        if (!*model) {
                          *model = loadModel(withoutFixedJoints(scene.mechanism), scene.gravity);
                        }
                        return std::make_unique<MujocoContender>(scene, outputs, *model);
                      }});
  }
}

}  // namespace virtual_work_dynamics
