// Notation of the package; this header is comments only. doc/theory.md derives the equations and
// has an index from each to its lines.
//
// Frames and points (Drake's monogram form, quantity_about_expressed):
//   0, root   the root link of the description, fixed to ground; the paper's T_0
//   P         the parent link of a joint, or the parent body in the recursion
//   K         the child link of a joint: origin Ko = O_k is the joint, axes are the URDF's
//   Z         the body of K re-oriented so that the joint axis is +z, the paper's u3;
//             Zo == Ko. The recursion runs in Z frames, the public interface in K frames
//   Cm        the centre of mass
//   Q, Rz     R_PZ of a revolute joint is Q Rz(q + phase): Q turns the parent's z axis into the
//             joint's by as few products as that takes, Rz turns about the joint axis
//   R_PK      rotation matrix: components in K -> components in P
//   p_PoKo_P  position vector from Po to Ko, expressed in P
//   w_K, F_K  angular velocity, force; expressed in K
//   M_Ko_K    moment about Ko, expressed in K
//
// Joint space:  q, qd, qdd (generalized positions, velocities, accelerations), effort.
//
// The paper (Stroe & Staicu 2010) and this code; equation numbers in code are the paper's. No
// letter of the column `code` means two things; Arrival::b always has its prefix.
//
// Trees (2.1)-(2.7), (3.5)-(3.8), (4.3):
//
//   paper            code                   meaning                                     unit
//   a_{k,k-1}^T      R_PK (R_PZ)            rotation between neighbouring bodies        -
//   a_{k0}^T         R_0K (R_0Z)            rotation to the fixed axes                  -
//   r_{k,k-1}        p_PoKo_P               parent origin to joint origin               m
//   omega_{k0}       w                      absolute angular velocity                   rad/s
//   epsilon_{k0}     alpha                  absolute angular acceleration               rad/s^2
//   v_{k0}           v                      absolute velocity of O_k                    m/s
//   gamma_{k0}       gamma                  absolute acceleration of O_k, less gravity  m/s^2
//   w~w~ + eps~      U                      acceleration gradient: a(r) = gamma + U r   1/s^2
//   -                arrival                w, alpha and, as arrival.b, gamma_p + U_p r: what
//                                           comes from the parent, in its axes
//   m_k, r_k^C       mass, p_KoCm_K         mass, centre of mass                        kg, m
//   m_k r_k^C        h                      first moment of mass about O_k              kg m
//   J_k              (from G)               inertia about O_k                           kg m^2
//   -                G = tr(J)/2 1 - J      second moment of mass, integral of r r^T dm kg m^2
//   f*_k, m*_k       applied wrench         applied forces other than weight            N, N m
//   F_k, M_k         F, M                   wrench that the PARENT exerts on body k,
//                                           moment about O_k                            N, N m
//   g                gravity                enters as gamma of the root link = -g       m/s^2
//
// A reaction is the total wrench (3.8) of the parent on the child; its component along the joint
// axis is the tree effort.
//
// Lagrange's equations (3.1), (4.1), (4.2):
//
//   E                E                      kinetic energy                              J
//   U                force function         minus the potential energy                  J
//   q_k, q_{h+1}     s, its velocity sd     direction of differentiation: a coordinate
//                                           or a fictitious mobility                    rad or m
//   R_{h+1}          reaction               force along the fictitious mobility         N, N m
//
// Conditions and multipliers (3.1)-(3.4):
//
//   Phi_i            phi                    position of a condition, Phi(q, t) = 0      m or -
//   a_ik             A, jacobian            velocity of a condition, A qd + b = 0       m or - per
//                                                                                       rad or m
//   b_i              b                      the part of a condition's velocity that
//                                           is not of qd: zero where time is not in it  m/s or 1/s
//   lambda_i         lambda, multiplier     the closure's force along its condition, of
//                                           the parent on the child                     N or N m
//   Q_k              S^T tau                generalized forces; those that are known
//                                           are part of tau_tree                        N m or N
//   -                tau_tree               efforts of the tree that is left when
//                                           closures are cut, moving as they make it    N m or N
//   -                tau                    efforts of actuated joints and closures     N m or N
//   -                S                      selects the coordinates that tau drives     -
//   -                B = [S^T A^T]          system matrix of a group of loops, scaled to
//                                           forces by a length: B x = load              -
//   -                x, load                [tau; lambda] and tau_tree, scaled          N
//
// Certificates and error bounds:
//
//   -                Y                      yardstick: sum of the norms of all terms    as the
//                                                                                       result
//   -                L                      steps in sequence behind a result           -
//
// Matrices of src/algebra/, which knows no mechanics, have letters of their own there, and so have
// derivatives of rotations in src/witness/momentum/.
