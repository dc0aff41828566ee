#include "maximal_coordinates_oracle.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "tooth_geometry.h"
#include "touch_geometry.h"

namespace virtual_work_dynamics {

template <typename Real>
MaximalCoordinates<Real>::MaximalCoordinates(const Mechanism& mechanism, const Scene& scene,
                                             const Motion& motion, Real pivot_tolerance)
    : mechanism_(mechanism),
      scene_(scene),
      bodies_(mechanism, withoutLoops(scene), motion),
      pivot_tolerance_(pivot_tolerance) {
  place();
  other_flank_.assign(scene.closures.size(), false);
  setUp(motion);
  if (turnsFlanks()) setUp(motion);
}

template <typename Real>
void MaximalCoordinates<Real>::place() {
  for (std::size_t k = 0; k < mechanism_.joints().size(); ++k) {
    const int child = mechanism_.joints()[k].child_link;
    const Vector3l& o = bodies_.origin(child);
    cuts_.push_back({mechanism_.joints()[k].name, mechanism_.joints()[k].parent_link, child, o,
                     bodies_.orientation(child), o});
  }
  const Vector3l& root = bodies_.origin(0);
  cuts_.push_back({kGround, -1, 0, root, bodies_.orientation(0), root});
  for (const Closure& closure : scene_.closures) {
    const PlacedFrame frame(mechanism_, bodies_, closure.child);
    Cut cut{closure.name,
            mechanism_.linkIndex(closure.parent.link),
            mechanism_.linkIndex(closure.child.link),
            frame.o,
            frame.R,
            frame.o};
    if (isTouch(closure)) {
      const PlacedTouch touch(mechanism_, bodies_, closure);
      cut.o = cut.reported = touch.o;
      cut.R = touch.R;
    }
    if (isMesh(closure)) cut.o = PlacedTeeth(mechanism_, bodies_, closure).o;
    cuts_.push_back(cut);
  }
  for (const Cut& cut : cuts_) length_ = std::max(length_, (cut.o - root).norm());
  for (std::size_t i = 0; i < mechanism_.links().size(); ++i) {
    length_ = std::max(length_, (bodies_.centreOfMass(static_cast<int>(i)) - root).norm());
  }
  if (length_ == 0) length_ = 1;
}

template <typename Real>
void MaximalCoordinates<Real>::setUp(const Motion& motion) {
  addBalances();
  for (std::size_t c = 0; c < scene_.closures.size(); ++c) addFreeDirections(c);
  addPassiveCoordinates(motion);
  solve();
}

template <typename Real>
bool MaximalCoordinates<Real>::turnsFlanks() {
  bool turns = false;
  for (std::size_t c = 0; c < scene_.closures.size(); ++c) {
    if (!isMesh(scene_.closures[c])) continue;
    const PlacedTeeth teeth(mechanism_, bodies_, scene_.closures[c]);
    const Eigen::Index force = at(mechanism_.joints().size() + 1 + c);
    if (x_.template segment<3>(force).dot(teeth.tangent.template cast<Real>()) >= 0) continue;
    other_flank_[c] = turns = true;
  }
  return turns;
}

template <typename Real>
Real MaximalCoordinates<Real>::sizeOfLoops() const {
  long double size = 0;
  for (const Closure& closure : scene_.closures) size = std::max(size, reachOf(closure));
  return static_cast<Real>(size / length_);
}

template <typename Real>
Real MaximalCoordinates<Real>::unborne() const {
  Real most = 0;
  if (freeMotions() == 0) return most;
  Eigen::FullPivLU<Matrix> lu;
  lu.setThreshold(pivot_tolerance_);
  const Matrix motions = lu.compute(G_.transpose()).kernel();
  for (Eigen::Index i = 0; i < motions.cols(); ++i) {
    const Real work = motions.col(i).dot(b_);
    const Real largest = motions.col(i).cwiseAbs().dot(b_.cwiseAbs());
    if (largest > 0) most = std::max(most, std::abs(work) / largest);
  }
  return most;
}

template <typename Real>
typename MaximalCoordinates<Real>::Reaction MaximalCoordinates<Real>::childAxes(
    const std::string& name) const {
  const Cut& cut = cuts_[indexOf(name)];
  return reaction(name, cut.R.transpose(), cut.o - cut.reported);
}

template <typename Real>
typename MaximalCoordinates<Real>::Reaction MaximalCoordinates<Real>::rootAxes(
    const std::string& name) const {
  const Cut& cut = cuts_[indexOf(name)];
  return reaction(name, bodies_.orientation(0).transpose(), cut.o - cut.reported);
}

template <typename Real>
typename MaximalCoordinates<Real>::Reaction MaximalCoordinates<Real>::rootAxesAbout(
    const std::string& name, const Vector3l& point) const {
  return reaction(name, Matrix3l::Identity(), cuts_[indexOf(name)].o - point);
}

template <typename Real>
typename MaximalCoordinates<Real>::Reaction MaximalCoordinates<Real>::childAxesAbout(
    const std::string& name, const Vector3l& point) const {
  const Cut& cut = cuts_[indexOf(name)];
  return reaction(name, cut.R.transpose(), cut.o - point);
}

template <typename Real>
bool MaximalCoordinates<Real>::rankDropsWithout(const std::string& name, int i) const {
  const Eigen::Index column = at(indexOf(name)) + i;
  Matrix left = G_;
  left.col(column) = left.template rightCols<1>();
  left.conservativeResize(Eigen::NoChange, left.cols() - 1);
  return rankOf(left) < rankOf(G_);
}

template <typename Real>
typename MaximalCoordinates<Real>::Effort MaximalCoordinates<Real>::effort(int coordinate) const {
  return effort(effortRow(coordinate), static_cast<Real>(terms_[coordinate]));
}

template <typename Real>
typename MaximalCoordinates<Real>::Effort MaximalCoordinates<Real>::closureEffort(
    const std::string& name) const {
  const std::size_t cut = indexOf(name);
  const Closure& closure = scene_.closures[cut - mechanism_.joints().size() - 1];
  Vector row = Vector::Zero(G_.cols());
  const bool cylinder = closure.type == ClosureType::kCylinder;
  const bool slides = cylinder || closure.type == ClosureType::kPrismatic;
  const PlacedFrame parent(mechanism_, bodies_, closure.parent);
  const Vector3l axis =
      cylinder ? Vector3l((cuts_[cut].o - parent.o).normalized()) : Vector3l(cuts_[cut].R.col(2));
  row.template segment<3>(at(cut) + (slides ? 0 : 3)) =
      (axis * (slides ? 1 : length_)).template cast<Real>();
  return effort(row, 0);
}

template <typename Real>
typename MaximalCoordinates<Real>::Effort MaximalCoordinates<Real>::couplingEffort(
    std::size_t coupling) const {
  return effort(Vector::Unit(G_.cols(), columnOf(coupling)) * static_cast<Real>(unitOf(coupling)),
                0);
}

template <typename Real>
Real MaximalCoordinates<Real>::violationBy(
    const std::function<Wrench(const std::string&)>& wrench_of) const {
  Vector x = Vector::Zero(G_.cols());
  for (std::size_t cut = 0; cut < cuts_.size(); ++cut) {
    const Wrench wrench = wrench_of(cuts_[cut].name);
    x.template segment<3>(at(cut)) = wrench.force.cast<Real>();
    x.template segment<3>(at(cut) + 3) =
        (wrench.torque.cast<long double>() / length_).template cast<Real>();
  }
  return violation(x);
}

template <typename Real>
Scene MaximalCoordinates<Real>::withoutLoops(Scene scene) {
  scene.closures.clear();
  scene.couplings.clear();
  scene.springs.clear();
  scene.actuated.reset();
  scene.assembly.clear();
  return scene;
}

template <typename Real>
std::size_t MaximalCoordinates<Real>::indexOf(const std::string& name) const {
  std::size_t cut = 0;
  while (cuts_.at(cut).name != name) ++cut;
  return cut;
}

template <typename Real>
long double MaximalCoordinates<Real>::reachOf(const Closure& closure) const {
  long double reach = 0;
  const auto include = [&](const Vector3l& o) {
    reach = std::max(reach, (o - bodies_.origin(0)).norm());
  };
  std::vector<bool> on_loop(mechanism_.joints().size(), false);
  for (const LinkFrame* frame : {&closure.parent, &closure.child}) {
    include(PlacedFrame(mechanism_, bodies_, *frame).o);
    int link = mechanism_.linkIndex(frame->link);
    for (; link > 0; link = mechanism_.joint(mechanism_.link(link).parent_joint).parent_link) {
      const auto joint = static_cast<std::size_t>(mechanism_.link(link).parent_joint);
      on_loop[joint] = !on_loop[joint];
    }
  }
  for (std::size_t k = 0; k < on_loop.size(); ++k) {
    if (on_loop[k]) include(cuts_[k].o);
  }
  return reach;
}

template <typename Real>
Matrix3l MaximalCoordinates<Real>::cross(const Vector3l& r) {
  Matrix3l m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

template <typename Real>
void MaximalCoordinates<Real>::addBalances() {
  const Eigen::Index links = static_cast<Eigen::Index>(mechanism_.links().size());
  rows_ = 6 * links;
  const Eigen::Index most = rows_ + at(scene_.closures.size()) +
                            static_cast<Eigen::Index>(mechanism_.coordinates().size());
  G_.setZero(most, columnOf(scene_.couplings.size()));
  b_.setZero(most);
  for (std::size_t cut = 0; cut < cuts_.size(); ++cut) {
    for (const int sign : {1, -1}) {
      const int link = sign > 0 ? cuts_[cut].child : cuts_[cut].parent;
      if (link < 0) continue;
      auto block = G_.template block<6, 6>(6 * link, at(cut));
      const Vector3l r = cuts_[cut].o - bodies_.centreOfMass(link);
      block.template topLeftCorner<3, 3>() = Real(sign) * Matrix3::Identity();
      block.template bottomRightCorner<3, 3>() = Real(sign) * Matrix3::Identity();
      block.template bottomLeftCorner<3, 3>() = (sign * cross(r) / length_).template cast<Real>();
    }
  }
  for (Eigen::Index link = 0; link < links; ++link) {
    const auto demand = bodies_.demand(static_cast<int>(link));
    load(static_cast<int>(link), bodies_.centreOfMass(static_cast<int>(link)), demand.force);
    b_.template segment<3>(6 * link + 3) += (demand.torque / length_).template cast<Real>();
  }
  for (const PointSpring& spring : scene_.springs) {
    const SpringForce pull(mechanism_, bodies_, spring);
    load(mechanism_.linkIndex(spring.link_a), pull.a, -pull.force_on_a);
    load(mechanism_.linkIndex(spring.link_b), pull.b, pull.force_on_a);
  }
}

template <typename Real>
void MaximalCoordinates<Real>::load(int link, const Vector3l& point, const Vector3l& force) {
  const Vector3l moment = (point - bodies_.centreOfMass(link)).cross(force);
  b_.template segment<3>(6 * link) += force.template cast<Real>();
  b_.template segment<3>(6 * link + 3) += (moment / length_).template cast<Real>();
}

template <typename Real>
void MaximalCoordinates<Real>::addRow(const Vector& row, Real value) {
  G_.row(rows_) = row.transpose();
  b_[rows_] = value;
  ++rows_;
}

template <typename Real>
Eigen::Index MaximalCoordinates<Real>::rankOf(const Matrix& matrix) const {
  Eigen::FullPivLU<Matrix> lu;
  lu.setThreshold(pivot_tolerance_);
  return lu.compute(matrix).rank();
}

template <typename Real>
void MaximalCoordinates<Real>::solve() {
  G_.conservativeResize(rows_, Eigen::NoChange);
  b_.conservativeResize(rows_);
  Eigen::FullPivLU<Matrix> lu;
  lu.setThreshold(pivot_tolerance_);
  lu.compute(G_);
  x_ = lu.solve(b_);
  for (Eigen::Index i = 0; i < lu.matrixLU().diagonalSize(); ++i) {
    const Real pivot = std::abs(lu.matrixLU()(i, i)) / lu.maxPivot();
    if (pivot > pivot_tolerance_) {
      least_counted_ = std::min(least_counted_, pivot);
    } else {
      largest_left_out_ = std::max(largest_left_out_, pivot);
    }
  }
  N_.resize(G_.cols(), 0);
  if (lu.dimensionOfKernel() == 0) return;
  const Matrix kernel = lu.kernel();
  N_ = Eigen::HouseholderQR<Matrix>(kernel).householderQ() *
       Matrix::Identity(kernel.rows(), kernel.cols());
}

template <typename Real>
Real MaximalCoordinates<Real>::violation(const Vector& x) const {
  return (G_ * x - b_).cwiseAbs().maxCoeff() / std::max(Real(1), b_.cwiseAbs().maxCoeff());
}

template <typename Real>
Real MaximalCoordinates<Real>::freedom(const Vector& row) const {
  return N_.cols() == 0 ? Real(0) : (row.transpose() * N_).norm();
}

template <typename Real>
typename MaximalCoordinates<Real>::Effort MaximalCoordinates<Real>::effort(const Vector& row,
                                                                           Real terms) const {
  const Real free = freedom(row);
  return {row.dot(x_) + terms, free <= kFree, free / row.norm()};
}

template <typename Real>
typename MaximalCoordinates<Real>::Reaction MaximalCoordinates<Real>::reaction(
    const std::string& name, const Matrix3l& axes, const Vector3l& lever) const {
  const Eigen::Index first = at(indexOf(name));
  Reaction reaction;
  for (int i = 0; i < 6; ++i) {
    const bool moment = i >= 3;
    Vector row = Vector::Zero(G_.cols());
    row.template segment<3>(first + (moment ? 3 : 0)) =
        axes.row(i % 3).transpose().template cast<Real>();
    if (moment) {
      const Vector3l axis = axes.row(i % 3).transpose();
      row.template segment<3>(first) = (axis.cross(lever) / length_).template cast<Real>();
    }
    reaction.wrench[i] = row.dot(x_) * static_cast<Real>(moment ? length_ : 1);
    reaction.freedom[static_cast<std::size_t>(i)] = freedom(row);
    reaction.determined[static_cast<std::size_t>(i)] = freedom(row) <= kFree;
  }
  return reaction;
}

template class MaximalCoordinates<double>;
template class MaximalCoordinates<long double>;

}  // namespace virtual_work_dynamics
