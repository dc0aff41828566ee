#include <optional>

#include "contenders/offers.h"
#include "contenders/own_request.h"
#include "lagrange_multipliers_oracle.h"
#include "maximal_coordinates_oracle.h"
#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

// All six components of the wrench in every joint and closure at once, one dense linear system.
class MaximalSystem : public Contender {
 public:
  MaximalSystem(const BenchmarkScene& scene, const std::string& outputs)
      : scene_(scene), names_(loopRequest(scene, outputs).child_axes) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      const MaximalCoordinates<double> system(scene_.mechanism, *scene_.loops,
                                              scene_.motions[cycle_.next()]);
      results_.efforts.clear();
      results_.reactions.clear();
      for (std::size_t i = 0; i < scene_.mechanism.coordinates().size(); ++i) {
        results_.efforts.push_back(system.effort(static_cast<int>(i)).value);
      }
      for (const std::string& name : names_) {
        const auto reaction = system.childAxes(name);
        results_.reactions.insert(results_.reactions.end(), reaction.wrench.data(),
                                  reaction.wrench.data() + 6);
      }
    }
  }

  SampleResults results(std::size_t) const override { return results_; }

 private:
  const BenchmarkScene& scene_;
  std::vector<std::string> names_;
  SampleResults results_;
  StateCycle cycle_;
};

// Lagrange's equations with multipliers (3.1), the tests' witness. It always gives all reactions,
// in root axes.
class LagrangeMultipliers : public Contender {
 public:
  explicit LagrangeMultipliers(const BenchmarkScene& scene)
      : scene_(scene), names_(loopRequest(scene, kEffortsAndReactions).child_axes) {}

  void run(std::size_t calls) override {
    for (; calls > 0; --calls) {
      motion_ = &scene_.motions[cycle_.next()];
      system_.emplace(scene_.mechanism, *scene_.loops, *motion_);
    }
  }

  SampleResults results(std::size_t) const override {
    const Mechanism& mechanism = scene_.mechanism;
    const NewtonEulerOracle bodies(mechanism, {}, *motion_);
    SampleResults results;
    for (std::size_t i = 0; i < mechanism.coordinates().size(); ++i) {
      results.efforts.push_back(system_->effort(static_cast<Eigen::Index>(i)));
    }
    for (const std::string& name : names_) {
      const Matrix3l R = childAxesOf(name, bodies).transpose();
      const Wrench wrench = system_->rootAxes(name);
      for (const Eigen::Vector3d& part : {wrench.force, wrench.torque}) {
        const Vector3l turned = R * part.cast<long double>();
        results.reactions.insert(results.reactions.end(), turned.data(), turned.data() + 3);
      }
    }
    return results;
  }

 private:
  Matrix3l childAxesOf(const std::string& name, const NewtonEulerOracle& bodies) const {
    const int joint = scene_.mechanism.jointIndex(name);
    if (joint >= 0) return bodies.orientation(joint + 1);
    for (const Closure& closure : scene_.loops->closures) {
      if (closure.name == name) return PlacedFrame(scene_.mechanism, bodies, closure.child).R;
    }
    throw Error("there is no joint or closure '" + name + "'");
  }

  const BenchmarkScene& scene_;
  std::vector<std::string> names_;
  const Motion* motion_ = nullptr;
  std::optional<LagrangeMultipliersOracle> system_;
  StateCycle cycle_;
};

}  // namespace

void offerLoopFormalisms(const BenchmarkScene& scene, std::vector<Offer>& offers) {
  // Cost grows with the cube of the number of bodies.
  constexpr std::size_t kMostJoints = 30;
  if (movableJoints(scene.mechanism).size() > kMostJoints) return;
  for (const char* outputs : {kEfforts, kEffortsAndReactions}) {
    offers.push_back({{"maximal_coordinates", "double", "single", outputs, 1}, [&scene, outputs] {
                        return std::make_unique<MaximalSystem>(scene, outputs);
                      }});
  }
  offers.push_back({{"lagrange", "long_double", "single", kEffortsAndReactions, 1},
                    [&scene] { return std::make_unique<LagrangeMultipliers>(scene); }});
}

}  // namespace virtual_work_dynamics
