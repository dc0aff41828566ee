#include "tree/plan_reduction.h"

#include <algorithm>
#include <string>
#include <unordered_set>

namespace virtual_work_dynamics {

namespace {

using Real = long double;

Vec3<Real> transposeTimes(const Mat3<Real>& A, const Vec3<Real>& v) {
  return {A.xx * v.x + A.yx * v.y + A.zx * v.z, A.xy * v.x + A.yy * v.y + A.zy * v.z,
          A.xz * v.x + A.yz * v.y + A.zz * v.z};
}

Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

bool isZero(const Vec3<Real>& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

bool inertialess(const Body<Real>& body) {
  const Sym3<Real>& G = body.G;
  return body.mass == 0 && isZero(body.h) && G.xx == 0 && G.xy == 0 && G.xz == 0 && G.yy == 0 &&
         G.yz == 0 && G.zz == 0;
}

// Fewer children of a hub than this are summed in sequence: the errors are as small.
constexpr std::size_t kPairwiseFrom = 8;

class Reduction {
 public:
  Reduction(Plan<Real>& plan, const std::vector<std::string>& names, const Vec3<Real>& gamma_root)
      : plan_(plan), bodies_(plan.bodies), names_(names), gamma_root_(gamma_root) {}

  void run() {
    markWrenches();
    markPointSteps();
    markPoses();
    markMotions();
    noteOmissions();
    dropUnused();
    startFromRest();
    keepUsedPositions();
    linkSweepOut();
    linkSweepIn();
    markEfforts();
    markPlain();
  }

 private:
  // A body's wrench is needed when it is reported, drives a requested effort, or is part of its
  // parent's; but not when it is zero: nothing with inertia or an applied wrench hangs on it.
  void markWrenches() {
    has_load_.assign(bodies_.size(), false);
    for (const auto& applied : plan_.applied) has_load_[applied.body] = true;
    for (std::size_t k = bodies_.size(); k-- > 0;) {
      if (!inertialess(bodies_[k])) has_load_[k] = true;
      if (k > 0 && has_load_[k]) has_load_[bodies_[k].parent] = true;
    }
    std::vector<bool> wanted(bodies_.size(), false);
    for (auto* outputs : {&plan_.child_axes, &plan_.root_axes}) {
      for (const auto& output : *outputs) wanted[output.body] = true;
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      Body<Real>& body = bodies_[k];
      if (plan_.efforts && body.coordinate >= 0) wanted[k] = true;
      if (k > 0 && wanted[body.parent]) wanted[k] = true;
      body.wrench_needed = wanted[k] && has_load_[k];
      body.has_inertia = body.wrench_needed && !inertialess(body);
      body.centred = isZero(body.h);
      body.diagonal = body.G.xy == 0 && body.G.xz == 0 && body.G.yz == 0;
      const bool slides = body.mobility == Mobility::kPrismatic;
      body.offset_x = body.p_PoZo_P.x != 0 || (slides && body.R_PZ.xz != 0);
      body.offset_y = body.p_PoZo_P.y != 0 || (slides && body.R_PZ.yz != 0);
      body.offset_z = body.p_PoZo_P.z != 0 || (slides && body.R_PZ.zz != 0);
      if (wanted[k] && !has_load_[k]) plan_.left_out.massless.push_back(names_[k]);
    }
    for (auto* outputs : {&plan_.child_axes, &plan_.root_axes}) {
      const bool may_have_pose = outputs == &plan_.root_axes && (plan_.poses || plan_.twists);
      for (auto& output : *outputs) {
        if (!bodies_[output.body].wrench_needed && !may_have_pose) output.body = -1;
      }
    }
    for (auto& applied : plan_.applied) {
      if (!bodies_[applied.body].wrench_needed) applied.body = -1;
    }
  }

  // The moment of a wrench that is zero is zero about every point.
  void markPointSteps() {
    std::vector<MovedMoment<Real>> kept;
    for (const MovedMoment<Real>& moved : plan_.moved) {
      const auto& outputs = moved.in_root_axes ? plan_.root_axes : plan_.child_axes;
      if (outputs[moved.output].body < 0) continue;
      kept.push_back(moved);
      for (int i = moved.steps_begin; i < moved.steps_end; ++i) {
        bodies_[plan_.point_steps[i].body].bears_point = true;
      }
    }
    plan_.moved = std::move(kept);
  }

  void needPose(int body) {
    plan_.any_pose = true;
    // Where a pose is needed already, those of the ancestors are.
    for (; body >= 0 && !bodies_[body].pose_needed; body = bodies_[body].parent) {
      bodies_[body].pose_needed = true;
    }
  }

  void markPoses() {
    std::vector<bool> moved(plan_.root_axes.size(), false);
    for (const auto& moment : plan_.moved) {
      if (moment.in_root_axes) moved[moment.output] = true;
    }
    for (std::size_t i = 0; i < plan_.root_axes.size(); ++i) {
      const ReactionOutput<Real>& output = plan_.root_axes[i];
      if (output.body < 0) continue;
      Body<Real>& body = bodies_[output.body];
      body.turned_by_parent = body.wrench_needed && output.body > 0 && !output.drop_active;
      const bool drops = body.wrench_needed && output.drop_active;
      if (drops || plan_.poses || plan_.twists || moved[i]) {
        needPose(output.body);
      } else if (body.parent > 0) {
        needPose(body.parent);
      }
    }
    for (const auto& applied : plan_.applied) {
      if (applied.body >= 0 && applied.in_root_axes) needPose(applied.body);
    }
  }

  void markMotions() {
    for (std::size_t k = bodies_.size(); k-- > 1;) {
      if (bodies_[k].has_inertia) bodies_[k].motion_needed = true;
      if (bodies_[k].motion_needed) bodies_[bodies_[k].parent].motion_needed = true;
    }
  }

  static bool used(const Body<Real>& body) {
    return body.wrench_needed || body.motion_needed || body.pose_needed || body.bears_point;
  }

  void noteOmissions() {
    plan_.left_out.velocity_terms = plan_.static_motion;
    plan_.left_out.gravity = isZero(gamma_root_) && !plan_.root_moves;
    const std::unordered_set<std::string> massless(plan_.left_out.massless.begin(),
                                                   plan_.left_out.massless.end());
    for (std::size_t k = 1; k < bodies_.size(); ++k) {
      if (!used(bodies_[k]) && massless.count(names_[k]) == 0) {
        plan_.left_out.unneeded.push_back(names_[k]);
      }
    }
  }

  // Ancestors of what is used stay, idle ones too, so that every body has its parent.
  void dropUnused() {
    std::vector<bool> stays(bodies_.size(), false);
    stays[0] = true;
    for (std::size_t k = bodies_.size(); k-- > 1;) {
      if (used(bodies_[k])) stays[k] = true;
      if (stays[k]) stays[bodies_[k].parent] = true;
    }
    std::vector<int> renumbered(bodies_.size(), -1);
    std::vector<Body<Real>> kept;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (!stays[k]) continue;
      renumbered[k] = static_cast<int>(kept.size());
      kept.push_back(bodies_[k]);
      kept_names_.push_back(names_[k]);
      if (k > 0) kept.back().parent = renumbered[kept.back().parent];
    }
    bodies_ = std::move(kept);
    for (auto* outputs : {&plan_.child_axes, &plan_.root_axes}) {
      for (auto& output : *outputs) {
        if (output.body >= 0) output.body = renumbered[output.body];
      }
    }
    for (PointStep& step : plan_.point_steps) step.body = renumbered[step.body];
    for (auto& applied : plan_.applied) {
      if (applied.body >= 0) applied.body = renumbered[applied.body];
    }
  }

  // Bodies on a root that rests, and on what is welded to it, start from a constant gamma and from
  // no w or alpha.
  void startFromRest() {
    std::vector<bool> rests(bodies_.size(), false);
    std::vector<Vec3<Real>> gamma(bodies_.size(), gamma_root_);
    rests[0] = !plan_.root_moves;
    const Body<Real>& root = bodies_[0];
    plan_.root_wrench.force = {root.mass * gamma_root_.x, root.mass * gamma_root_.y,  // (3.5)
                               root.mass * gamma_root_.z};
    plan_.root_wrench.torque = cross(root.h, gamma_root_);
    for (std::size_t k = 1; k < bodies_.size(); ++k) {
      Body<Real>& body = bodies_[k];
      body.parent_rests = rests[body.parent];
      if (!body.parent_rests) continue;
      gamma[k] = body.gamma_rest = transposeTimes(body.R_PZ, gamma[body.parent]);  // (2.7) at rest
      body.rest_along_z = body.gamma_rest.x == 0 && body.gamma_rest.y == 0;
      body.weightless = isZero(body.gamma_rest) && body.mobility != Mobility::kPrismatic;
      rests[k] = body.mobility == Mobility::kFixed;
      if (body.motion_needed) plan_.left_out.at_rest.push_back(kept_names_[k]);
    }
  }

  // The position of a joint matters to its body's pose, to its wrench in its parent's axes, whether
  // it is reported or added there, and to the gamma that arrives from its parent.
  bool positionMatters(const Body<Real>& body) const {
    if (body.pose_needed || body.bears_point || body.turned_by_parent) return true;
    if (body.wrench_needed && bodies_[body.parent].wrench_needed) return true;
    if (!body.motion_needed) return false;
    if (!body.parent_rests) return true;
    return body.mobility == Mobility::kRevolute && !body.rest_along_z;
  }

  void keepUsedPositions() {
    std::vector<JointPosition<Real>> angles, slides;
    for (std::size_t k = 1; k < bodies_.size(); ++k) {
      Body<Real>& body = bodies_[k];
      if (body.coordinate < 0) continue;
      if (!positionMatters(body)) {
        body.angle = body.slide = -1;
        if (used(body)) plan_.left_out.idle.push_back(kept_names_[k]);
      } else if (body.mobility == Mobility::kRevolute) {
        angles.push_back(plan_.angles[body.angle]);
        if (angles.back().geared) plan_.geared_angles = true;
        body.angle = static_cast<int>(angles.size()) - 1;
      } else {
        slides.push_back(plan_.slides[body.slide]);
        body.slide = static_cast<int>(slides.size()) - 1;
      }
    }
    plan_.angles = std::move(angles);
    plan_.slides = std::move(slides);
  }

  // A body whose parent was not the one before it reads the parent's motion from a slot.
  void linkSweepOut() {
    int last = 0;
    for (int k = 1; k < static_cast<int>(bodies_.size()); ++k) {
      Body<Real>& body = bodies_[k];
      if (!body.motion_needed) continue;
      if (!body.parent_rests && body.parent != last) {
        Body<Real>& parent = bodies_[body.parent];
        if (parent.own_slot < 0) parent.own_slot = plan_.slots++;
        body.parent_slot = parent.own_slot;
      } else if (!body.parent_rests) {
        bodies_[last].feeds = k;
      }
      last = k;
    }
  }

  void linkSweepIn() {
    int later = -1;
    for (int k = static_cast<int>(bodies_.size()); k-- > 0;) {
      if (!bodies_[k].wrench_needed) continue;
      if (later >= 0 && bodies_[later].parent == k) {
        bodies_[later].hands_on = true;
        bodies_[k].takes_from_next = true;
      } else if (later >= 0 && bodies_[bodies_[later].parent].wrench_needed) {
        bodies_[later].adds_to_parent = true;
        bodies_[later].sums_into = bodies_[later].parent;
      }
      later = k;
    }
    sumHubsPairwise();
    for (std::size_t i = 0; i < plan_.child_axes.size(); ++i) {
      Body<Real>* const body = reportedBody(plan_.child_axes[i]);
      if (body) body->child_axes = static_cast<int>(i);
      if (!body) plan_.child_zeros = true;
    }
    for (std::size_t i = 0; i < plan_.root_axes.size(); ++i) {
      Body<Real>* const body = reportedBody(plan_.root_axes[i]);
      if (body) body->root_axes = static_cast<int>(i);
      if (!body) plan_.root_zeros = true;
    }
  }

  // The body whose wrench is reported, if it is not known to be zero.
  Body<Real>* reportedBody(const ReactionOutput<Real>& output) {
    if (output.body < 0 || !bodies_[output.body].wrench_needed) return nullptr;
    bodies_[output.body].reported = true;
    return &bodies_[output.body];
  }

  // Departs from (3.8): a sum over children. Those of a hub go two by two into partial sums of 1,
  // 2, 4... children, as a binary counter counts; what is left in the end goes into the hub's own
  // wrench.
  void sumHubsPairwise() {
    plan_.wrenches = static_cast<int>(bodies_.size());
    std::vector<std::vector<int>> children(bodies_.size());  // of each hub, in the sweep's order
    for (int k = static_cast<int>(bodies_.size()); k-- > 1;) {
      if (bodies_[k].adds_to_parent) children[bodies_[k].parent].push_back(k);
    }
    for (std::size_t hub = 0; hub < bodies_.size(); ++hub) {
      if (children[hub].size() < kPairwiseFrom) continue;
      int sums = 0;
      while (children[hub].size() >> sums) ++sums;
      for (std::size_t n = 0; n < children[hub].size(); ++n) {
        addChild(bodies_[children[hub][n]], n, n + 1 == children[hub].size());
      }
      plan_.wrenches += sums;
    }
  }

  // Adds a child after `n` others; the bits of n say which partial sums there are.
  void addChild(Body<Real>& child, std::size_t n, bool last) {
    const auto bit = [](std::size_t number, int i) { return (number >> i & 1) != 0; };
    child.sums_into = plan_.wrenches;
    child.starts_sum = !bit(n, 0);
    child.carries_begin = static_cast<int>(plan_.carries.size());
    for (int i = 0; bit(n, i); ++i) {
      plan_.carries.push_back({plan_.wrenches + i, plan_.wrenches + i + 1, !bit(n, i + 1)});
    }
    int carried = -1;
    for (int i = 0; last && (n + 1) >> i; ++i) {
      if (!bit(n + 1, i)) continue;
      if (carried >= 0) plan_.carries.push_back({carried, plan_.wrenches + i, false});
      carried = plan_.wrenches + i;
    }
    if (last) plan_.carries.push_back({carried, child.parent, false});
    child.carries_end = static_cast<int>(plan_.carries.size());
  }

  void markEfforts() {
    if (!plan_.efforts) return;
    std::vector<bool> driven(static_cast<std::size_t>(plan_.coordinates), false);
    for (std::size_t k = bodies_.size(); k-- > 1;) {
      Body<Real>& body = bodies_[k];
      if (body.coordinate < 0 || !body.wrench_needed) continue;
      body.drives = true;
      body.summed = driven[body.coordinate];
      driven[body.coordinate] = true;
    }
    for (int i = 0; i < plan_.coordinates; ++i) {
      if (!driven[i]) plan_.zero_efforts.push_back(i);
    }
  }

  void markPlain() {
    for (std::size_t k = 1; k < bodies_.size(); ++k) {
      Body<Real>& body = bodies_[k];
      if (body.mobility != Mobility::kRevolute || body.geared || body.angle < 0) continue;
      const bool plain = body.motion_needed && body.has_inertia && !body.parent_rests &&
                         body.parent_slot < 0 && body.own_slot < 0;
      body.plain_motion = plain && !body.pose_needed;
      body.turned_motion = plain && body.pose_needed;
      if (!body.wrench_needed || !body.drives || body.summed || !body.hands_on) continue;
      if (dropsActive(body)) continue;
      body.plain_wrench = body.root_axes >= 0    ? PlainReport::kRootAxes
                          : body.child_axes >= 0 ? PlainReport::kChildAxes
                                                 : PlainReport::kNone;
    }
  }

  bool dropsActive(const Body<Real>& body) const {
    return (body.child_axes >= 0 && plan_.child_axes[body.child_axes].drop_active) ||
           (body.root_axes >= 0 && plan_.root_axes[body.root_axes].drop_active);
  }

  Plan<Real>& plan_;
  std::vector<Body<Real>>& bodies_;
  const std::vector<std::string>& names_;
  std::vector<std::string> kept_names_;
  Vec3<Real> gamma_root_;
  std::vector<bool> has_load_;
};

}  // namespace

void reducePlan(Plan<Real>& plan, const std::vector<std::string>& names,
                const Vec3<Real>& gamma_root) {
  Reduction(plan, names, gamma_root).run();
}

}  // namespace virtual_work_dynamics
