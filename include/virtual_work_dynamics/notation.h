// Notation of the package; this header is comments only.
//
// Frames and points (Drake's monogram form, quantity_about_expressed):
//   0, root   the root link of the description, fixed to ground; the paper's T_0
//   P         the parent link of a joint, or the parent body in the recursion
//   K         the child link of a joint: origin Ko = O_k is the joint, axes are the URDF's
//   Z         the same body re-oriented so that the joint axis is +z, the paper's u3;
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
// The paper (Stroe & Staicu 2010) and this code; equation numbers in code are the paper's:
//
//   paper            code                   meaning                                     unit
//   a_{k,k-1}^T      R_PK (R_PZ)            rotation between neighbouring bodies        -
//   a_{k0}^T         R_0K (R_0Z)            rotation to the fixed axes                  -
//   r_{k,k-1}        p_PoKo_P               parent origin to joint origin               m
//   omega_{k0}       w                      absolute angular velocity                   rad/s
//   epsilon_{k0}     alpha                  absolute angular acceleration               rad/s^2
//   gamma_{k0}       gamma                  absolute acceleration of O_k, less gravity  m/s^2
//   w~w~ + eps~      U                      acceleration gradient: a(r) = gamma + U r   1/s^2
//   -                arrival                w, alpha and b = gamma_p + U_p r, parent's axes
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
