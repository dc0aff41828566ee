#pragma once

#include <cstddef>

#include "virtual_work_dynamics/instruction_set.h"

namespace virtual_work_dynamics {

// Kinematics of links and closures, compiled once for each instruction set behind plain pointers,
// under the rules of tree/kernel/kernel.h: for one sample, or for a pack of samples side by side,
// where each number stands for the neighbouring ones of all samples.

/// Numbers of a link, in root axes: axes R by columns, origin o and axis z of its joint; of the
/// origin v, w, a and alpha.
enum LinkNumber {
  kLinkR = 0,
  kLinkO = 9,
  kLinkZ = 12,
  kLinkV = 15,
  kLinkW = 18,
  kLinkA = 21,
  kLinkAlpha = 24,
  kLinkNumbers = 27
};

/// Numbers of a closure's frames, see FramePair: axes of P and C by columns, then their origins.
enum FrameNumber { kFrameP = 0, kFrameC = 9, kFramePo = 18, kFrameCo = 21, kFrameNumbers = 24 };

/// Numbers of a ClosureWrench.
constexpr int kWrenchNumbers = 6;

/// How a joint turns or shifts its link's axes.
enum class JointKind {
  kTurnsObliquely,  ///< about any axis
  kTurnsPlainly,    ///< about one of the parent's axes, with which its own are parallel at zero
  kSlides,
  kFixed
};

/// The joint that carries a link.
struct JointShape {
  JointKind kind;
  int parent;      ///< link; 0 is the root, which rests
  int coordinate;  ///< -1 where it is fixed
  int angle;       ///< in LinksView::angles; -1 where it does not turn
  int axis;        ///< of the parent's axes, where it turns plainly
  double sign;     ///< of that axis
  double multiplier, offset;
  double p_PoKo_P[3], axis_P[3];
  // Of the child's axes in the parent's, by columns: still + cos(angle) across + sin(angle) turned.
  double still[9], across[9], turned[9];
};

struct AngleShape {
  int coordinate;
  double multiplier, offset;
};

struct LinksView {
  const JointShape* joints;  ///< of link i + 1
  const AngleShape* angles;
  int joint_count, angle_count;
};

/// A number of angles that leaves room for packs of angles of one sample.
constexpr int kMostAngleLanes = 8;

/// A joint on the path of a closure that moves.
struct StepShape {
  int link;  ///< that the joint carries
  int coordinate;
  bool slides;
  bool starts;    ///< whether it is the first with its coordinate
  double factor;  ///< of the coordinate's rate, for the child relative to the parent
};

/// See ClosureDemand.
struct DemandShape {
  enum class Kind { kAlong, kNormal, kDistance };
  Kind kind;
  int a, b;
};

/// A frame that is fixed on a link.
struct FrameShape {
  int link;
  bool parallel;  ///< to the link's axes
  double R_LF[9], p_LoFo_L[3];
};

/// What touches a plane, see TouchConditions.
struct TouchShape {
  enum class Axes { kOfPlane, kOfWheel, kOfBlade };
  Axes axes;  ///< whose the x of the contact is
  double radius, tube_radius;
  // Of the conditions, in axes of the contact, and whether they restrict positions.
  double directions[3][3];
  bool has_position[3];
};

/// How the axes of a contact lie, by columns, where it lies from the child's origin, and how both
/// change.
enum ContactNumber {
  kContactR = 0,
  kContactRd = 9,
  kContactLever = 18,
  kContactLeverd = 21,
  kContactNumbers = 24
};

/// Teeth that mesh, see GearConditions.
struct TeethShape {
  bool is_rack;
  double parent_radius, child_radius;
  double radial, axial;    ///< shares of the tangential force
  const int* coordinates;  ///< of the row's terms
  const double* factors;
  int terms;
};

/// Where teeth mesh: the pitch point from the child's origin, and the directions there.
enum MeshNumber { kMeshLever = 0, kMeshAlong = 3, kMeshAxis = 6, kMeshAway = 9, kMeshNumbers = 12 };

struct ClosureShape {
  FrameShape parent, child;
  const StepShape* steps;
  int step_count, demand_count;
  DemandShape demands[6];
  double length;
  int along;  ///< how many demands, the first, are kAlong where all others are kNormal; else -1
  const TouchShape* touch;  ///< null where nothing touches; else its demands are kAlong
  const TeethShape* teeth;  ///< null where no teeth mesh; else its demand is kAlong
};

/// The numbers of one closure's conditions.
struct ClosureNumbers {
  double* phi;
  double* A;  ///< its first row; the columns are A_stride numbers apart
  std::size_t A_stride;
  double* wrenches;  ///< of unit multipliers
  double* frames;
  double* turning;  ///< Ad qd
};

/// The rows of a set of conditions in the Jacobian.
struct RowsShape {
  const int* coordinates;  ///< that have entries in them
  int coordinate_count, rows;
  std::size_t A_stride;  ///< from one column to the next
};

/// Columns of a set's rows that are copied with other units.
struct ScaledColumn {
  int coordinate;
  int place;  ///< of the column among the copies
  double factor;
};
struct ScaledColumns {
  const ScaledColumn* columns;
  int count;
  int height;  ///< from one copy to the next
};

/// What tells how far closures are violated.
struct ResidualsView {
  const RowsShape* rows;  ///< by closure
  const int* lengths;     ///< by closure: how many of its conditions, the first, are lengths
  int closures;
  double share;          ///< one over the length
  const double* scales;  ///< by coordinate
  int coordinates;
};
struct ResidualNumbers {
  const double* conditions[3];  ///< Phi and its derivatives
  const double *qd, *qdd;
  double *plain, *relative;  ///< by closure; of each position, velocity and acceleration
};

/// What is not reported of a wrench: where no actuator's part is wanted, what the joint does not
/// bear.
enum class LeftOut {
  kNothing,
  kForceAlong,
  kMomentAbout,
  kPlanar,
  kCylindrical,
  kScrew,
  kSpherical,
  kFloating,
  kUniversal
};

/// A closure whose wrench passes through a joint.
struct PassageShape {
  int closure;
  double sign;  ///< PathStep::sign
};

/// A reaction that is reported.
struct ReactionShape {
  int closure;  ///< -1: it is a joint's, or the ground's
  int link;     ///< that the joint carries
  LeftOut left_out;
  int first_link;      ///< that the first part of a universal joint carries
  double pitch;        ///< of a screw, m/rad
  int point_link;      ///< of the point of the moment; -1: it is the child frame's origin
  double p_LoPo_L[3];  ///< that point
  int passages_begin, passages_end;  ///< of ReactionsView::passages
};

struct ReactionsView {
  const ReactionShape* shapes;
  const PassageShape* passages;
  int count;
  bool child_axes;
};

struct ReactionNumbers {
  const double *links, *frames;
  const double* closures;   ///< their wrenches
  const double* tree;       ///< six numbers of each reaction of the open tree
  std::size_t tree_stride;  ///< from one of these numbers to the next
  double* values;
};

struct LoopFunctions {
  /// Sets R, o and z of all links but the root.
  /// @param angles room for twice as many numbers as there are angles and kMostAngleLanes
  void (*placeLinks)(const LinksView&, const double* q, double* angles, double* links);
  /// Sets v, w, a and alpha for qdd = 0.
  void (*moveLinks)(const LinksView&, const double* qd, double* links);
  /// Sets phi but for teeth, A, the wrenches' parts that differ from zero, and the frames.
  void (*placeClosure)(const ClosureShape&, const double* links, const ClosureNumbers&);
  /// Sets turning.
  void (*moveClosure)(const ClosureShape&, const double* links, const ClosureNumbers&);
  /// Sets phi of teeth, and its roundings.
  void (*sumTurns)(const TeethShape&, const double* q, double* phi, double* rounding);
  // In what follows A points to the first row of a set.
  /// Adds A u to sums.
  void (*addColumns)(const RowsShape&, const double* A, const double* u, double* sums);
  /// Adds A qd to rates and A qdd to accelerations.
  void (*addMotion)(const RowsShape&, const double* A, const double* qd, const double* qdd,
                    double* rates, double* accelerations);
  /// Copies columns of A, each entry times the factors of its row and column.
  void (*scaleColumns)(const RowsShape&, const ScaledColumns&, const double* row_factors,
                       const double* A, double* to);
  /// Finds how far closures are violated; see LoopResults.
  void (*residuals)(const ResidualsView&, const ResidualNumbers&);
  /// Sums the wrenches of a closure's multipliers x, in units of their own, to six numbers.
  void (*sumWrenches)(const ClosureShape&, const double* units, const double* x,
                      const double* wrenches, double* sum);
  /// Puts the wrench that teeth exert with the flank that bears below zero in place of the sum.
  /// @param bearing below zero where it is this flank
  void (*takeFlank)(const ClosureShape&, const double* units, const double* x,
                    const double* bearing, const double* frames, double* sum);
  /// Refers the wrench of what touches to the origin of the frame on the child's link.
  void (*referToChild)(const ClosureShape&, const double* links, const double* frames,
                       double* wrench);
  /// Sets two wrenches of each closure: on its child about the child frame's origin, and on its
  /// parent about the parent frame's.
  void (*closureLoads)(int closures, const double* frames, const double* wrenches, double* loads);
  void (*reactions)(const ReactionsView&, const ReactionNumbers&);
  // Of one sample, also where the others are of packs: what is reported of a wrench in root axes
  // about the child frame's origin, in the same axes about the same point, and as it is reported.
  void (*leaveOut)(const ReactionShape&, const double* links, const double* frames, double* wrench);
  void (*report)(const ReactionShape&, bool child_axes, const double* links, const double* frames,
                 double* wrench);
  // Of one sample, too: see ContactNumber and MeshNumber.
  /// @param w how the child's frame turns as the parent sees it
  void (*findContact)(const ClosureShape&, const double* links, const double* w, double* contact);
  void (*findMesh)(const ClosureShape&, const double* frames, double* mesh);
};

struct LoopKernel {
  int width;  ///< samples of a pack
  LoopFunctions one, pack;
};

// Null where the compiler cannot make one.
const LoopKernel* baselineLoops();
const LoopKernel* avx2Loops();
const LoopKernel* avx512Loops();

/// @throws Error when the instruction set is not supported.
const LoopKernel& loopKernelFor(InstructionSet instruction_set);

}  // namespace virtual_work_dynamics
