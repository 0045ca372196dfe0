// What can be said of the boxes in the lanes: proved, broken at a centre, outside of limits, or along what to cut.
#pragma once

#include "certify/halving.hpp"
#include "certify/limit_models.hpp"
#include "certify/matrix_models.hpp"
#include "certify/stiffness_models.hpp"
#include "certify/strays.hpp"

namespace flexapod {

using certify_task::Finding;
using certify_task::Kind;
using certify_task::Task;
using certify_task::Verdict;

/// The sign of det B, or 0 where it is small beyond doubt of rounding.
inline int sign_of_determinant(Mat6<double> m) {
  int sign = 1;
  for (int k = 0; k < 6; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 6; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    if (!(std::abs(m[pivot][k]) > 0)) return 0;
    if (pivot != k) std::swap(m.a[k], m.a[pivot]), sign = -sign;
    if (m[k][k] < 0) sign = -sign;
    for (int i = k + 1; i < 6; ++i) {
      const double factor = m[i][k] / m[k][k];
      for (int j = k; j < 6; ++j) m[i][j] -= factor * m[k][j];
    }
  }
  return sign;
}

/// n = 6: boxes of coordinates; n = 1: spans of a path. strays: how many numbers of the design may stray.
template <class Lane, int n, int strays = 0, class Rules = Sound> class Looking {
 public:
  using T = Taylor<Lane, n, 3, Rules, strays>;
  using Settled = Taylor<Lane, n, 3, Rules>;
  using Low = Taylor<Lane, n, 2, Rules, strays>;             // of limits
  using Place = std::conditional_t<strays == 0, double, T>;  // of a joint
  using LowPlace = std::conditional_t<strays == 0, double, Low>;
  using Places = std::conditional_t<strays == 0, const Design<double>&, const StrayingPlaces<T>>;
  using LowPlaces = std::conditional_t<strays == 0, const Design<double>&, const StrayingPlaces<Low>>;

  explicit Looking(const Task& task)
      : task_(task),
        machine_(*reinterpret_cast<const Design<double>*>(task.design), task.joint),
        places_(places<Places>()),
        low_places_(places<LowPlaces>()),
        platform_([this]() -> Mat6<Place> {
          if constexpr (strays == 0) return platform_inertia(places_, Mat3<double>::identity()).matrix();
          else return loaded_platform<T>(places_, task_.payload[0]);
        }()),
        home_(home_of(task)),
        size_(mean_radius(machine_.design)),
        law_(task.kind == Kind::index && machine_.features.law != Law::constant),
        others_(task.kind == Kind::index && machine_.features.others()),
        within_law_(law_ && lengths_within_law()) {}

  void look(double level, const Box* boxes, int count, Finding* found) {
    for (int l = 0; l < Lane::lanes; ++l) boxes_[l] = &boxes[std::min(l, count - 1)];
    pose_ = [&] {
      if constexpr (n == 1) return path_pose<T>(task_, boxes_);
      else return box_pose<T>(boxes_);
    }();
    const Pose<T> base{-transposed(pose_.R, pose_.t), transpose(pose_.R)};
    for (int l = 0; l < count; ++l) found[l] = start(l);
    if (task_.limits == nullptr || !judge_limits(base, count, found)) judge_matrix(base, level, count, found);
    for (int l = 0; l < count; ++l)
      if (n == 6 && width(*boxes_[l], found[l].axis) < smallest) found[l].axis = -1;
  }

 private:
  static constexpr double smallest = strays == 0 ? 0x1p-30 : 0x1p-12;  // what strays does not shrink with the box

  const Task task_;
  const Machine<double> machine_;
  const Places places_;
  const LowPlaces low_places_;
  const Mat6<Place> platform_;
  const Pose<double> home_;
  const double size_;
  const bool law_, others_, within_law_;  // what of the springs counts; whether limits keep lengths in the law's range
  const Box* boxes_[Lane::lanes];
  Pose<T> pose_;
  SpringMatrix<T> directions_;
  Mat6<T> M_, K_;       // inertia; stiffness of springs that do not lie along the legs
  Lane beyond_law_[6];  // 1 where a leg at the centre is
  MatrixModel<Settled> A_;
  mask_t<Lane> hopeless_;
  HalvingTest<Lane, n, Rules> test_;

  template <class Chosen> Chosen places() const {
    if constexpr (strays == 0) return machine_.design;
    else return {machine_.design, task_};
  }
  static Pose<double> home_of(const Task& task) {
    Pose<double> home{};
    const double* at = task.home;
    if (at == nullptr) return home;
    for (Vec3<double>* row : {&home.t, &home.R.row[0], &home.R.row[1], &home.R.row[2]})
      *row = {at[0], at[1], at[2]}, at += 3;
    return home;
  }

  Finding start(int l) const {
    Finding f{
        Verdict::open, widest(*boxes_[l]), std::numeric_limits<double>::quiet_NaN(), 0, -1, -1, {}, false, false, {}};
    const Vec3<T>* rows[4] = {&pose_.t, &pose_.R.row[0], &pose_.R.row[1], &pose_.R.row[2]};
    for (int r = 0; r < 4; ++r) {
      f.pose[3 * r] = lane_of(rows[r]->x.c[0], l);
      f.pose[3 * r + 1] = lane_of(rows[r]->y.c[0], l);
      f.pose[3 * r + 2] = lane_of(rows[r]->z.c[0], l);
    }
    return f;
  }
  /// Where nothing better is known: the widest side.
  int widest(const Box& box) const {
    int axis = 0;
    double most = -1.0;
    for (int i = 0; i < n; ++i)
      if (width(box, i) > most) most = width(box, i), axis = i;
    return axis;
  }
  /// Of a side, with lengths by the platform's size.
  double width(const Box& box, int i) const { return (box.high[i] - box.low[i]) / (i < 3 ? size_ : 1.0); }

  /// True where limits leave nothing to be looked at.
  bool judge_limits(const Pose<T>& base, int count, Finding* found) const {
    const LimitModels<Low, LowPlace> limits(*task_.limits, task_.home == nullptr ? nullptr : &home_, machine_,
                                            low_places_, cut(base));
    bool all = true;
    for (int l = 0; l < count; ++l) {
      limits.judge(l, task_.kind == Kind::limits, found[l]);
      all = all && found[l].verdict == Verdict::outside;
    }
    return all || task_.kind == Kind::limits;
  }

  static Pose<Low> cut(const Pose<T>& pose) {
    const auto vector = [](const Vec3<T>& v) {
      return Vec3<Low>(v.x.template cut<2>(), v.y.template cut<2>(), v.z.template cut<2>());
    };
    return {vector(pose.t), {{vector(pose.R.row[0]), vector(pose.R.row[1]), vector(pose.R.row[2])}}};
  }

  void judge_matrix(const Pose<T>& base, double level, int count, Finding* found) {
    set_matrices(Geometry<T, Place>(places_, base), base.R);
    const CentreModes<Lane> modes = centre_modes();
    note_centres(modes, count, found);
    bool proved[Lane::lanes];
    FrameRows<Lane> C;
    if (task_.kind == Kind::condition) {
      const Lane c2(level * level * (1.0 - 0x1p-46)), mu = sqrt(modes.square[0] * (modes.square[5] / c2));
      modes.frame(mu, false, C);
      prove(C, 1.0, -mu, count, proved);
      for (int l = 0; l < count; ++l) settle(level, l, proved[l], found[l]);
      modes.frame(c2 * mu, true, C);
      bool also[Lane::lanes];
      prove(C, -1.0, c2 * mu, count, also);
      for (int l = 0; l < count; ++l) {
        if (!proved[l]) continue;
        found[l].verdict = Verdict::open;
        proved[l] = also[l];
        settle(level, l, proved[l], found[l]);
      }
    } else {
      const Lane t(task_.kind == Kind::index ? level * level * (1.0 + 0x1p-46) : 0.0);
      modes.frame(t, false, C);
      prove(C, 1.0, -t, count, proved);
      for (int l = 0; l < count; ++l) settle(level, l, proved[l], found[l]);
      if (law_ && !within_law_) note_law(count, found);
    }
  }

  /// The springs' directions, and what stiffness is compared with: inertia, or lengths and angles where directions alone
  /// are asked for.
  void set_matrices(const Geometry<T, Place>& g, const Mat3<T>& base) {
    SpatialInertia<T> legs{}, others{};
    for (int i = 0; i < 6; ++i) {
      const LegAxes<T> leg(g.S[i], g.k[i], machine_.joint);
      set_spring_directions(directions_, i, g.q_p[i], leg);
      if (task_.kind == Kind::index) add_leg_inertia(legs, leg, machine_.inertia[i], g.q_p[i]);
      if (law_) scale_direction(i, leg.L);
      if (others_ && machine_.features.joints)
        add_joint_stiffness(others, leg, machine_.design.springs[i], g.q_p[i], machine_.joint);
    }
    if (others_ && machine_.features.suspension) add_suspension(others, machine_.design, Mat3<T>::identity(), base);
    if (others_) K_ = others.matrix();
    M_ = legs.matrix();
    const double turn = task_.kind == Kind::regular ? size_ * size_ : 1.0;
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s < 6; ++s)
        M_[r][s] += task_.kind == Kind::index ? platform_[r][s] : r != s ? 0.0 : r < 3 ? 1.0 : turn;
  }

  /// By a law, the stiffness is in the direction.
  void scale_direction(int i, const T& L) {
    const T root = sqrt(leg_stiffness(machine_, i, L, within_law_, beyond_law_[i]));
    for (int r = 0; r < 6; ++r) directions_[r][i] *= root;
  }
  double stiffness(int j) const { return task_.kind == Kind::index && !law_ ? machine_.axial.constant[j] : 1.0; }

  bool lengths_within_law() const {
    if (task_.limits == nullptr) return false;
    for (int i = 0; i < 6; ++i)
      for (const double end : task_.limits->length[i])
        if (!(machine_.axial.room(machine_.design, machine_.features, i, end) > 0.0)) return false;
    return true;
  }
  /// A pose at which a leg's stiffness is not known has no index.
  void note_law(int count, Finding* found) const {
    for (int i = 0; i < 6; ++i)
      for (int l = 0; l < count; ++l)
        if (lane_of(beyond_law_[i], l) > 0.0 && found[l].limit < 0) {
          found[l].verdict = Verdict::broken, found[l].value = std::numeric_limits<double>::quiet_NaN();
          found[l].limit = static_cast<int>(BrokenLimit::stiffness_law), found[l].leg = i;
        }
  }

  CentreModes<Lane> centre_modes() const {
    const SpringMatrix<Lane> along = root_directions();
    if (!others_) return {constant_of(M_), along};
    const Mat6<Lane> root = semidefinite_root(constant_of(K_));
    Mat6<Lane, spring_count + 6> F;
    for (int r = 0; r < 6; ++r)
      for (int j = 0; j < 6; ++j) F[r][j] = along[r][j], F[r][spring_count + j] = root[r][j];
    return {constant_of(M_), F};
  }

  static Mat6<Lane> constant_of(const Mat6<T>& models) {
    Mat6<Lane> centre;
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s < 6; ++s) centre[r][s] = models[r][s].c[0];
    return centre;
  }
  SpringMatrix<Lane> root_directions() const {
    SpringMatrix<Lane> F;
    for (int r = 0; r < 6; ++r)
      for (int j = 0; j < spring_count; ++j) F[r][j] = directions_[r][j].c[0] * std::sqrt(stiffness(j));
    return F;
  }

  /// Values and signs at the centres.
  void note_centres(const CentreModes<Lane>& modes, int count, Finding* found) const {
    const SpringMatrix<Lane> F = root_directions();
    for (int l = 0; l < count; ++l) {
      const double least = lane_of(modes.square[0], l), most = lane_of(modes.square[5], l);
      if (task_.kind == Kind::index) found[l].value = std::sqrt(least);
      if (task_.kind == Kind::condition) found[l].value = std::sqrt(most / least);
      Mat6<double> H;
      for (int r = 0; r < 6; ++r)
        for (int j = 0; j < 6; ++j) H[r][j] = lane_of(F[r][j], l);
      found[l].sign =
          least > 1e-20 * most && !others_ ? sign_of_determinant(H) : 0;  // other springs hold by themselves
    }
  }

  void settle(double level, int l, bool proved, Finding& f) const {
    if (f.verdict == Verdict::outside) return;
    const bool below =
        (task_.kind == Kind::index && f.value < level) || (task_.kind == Kind::condition && f.value > level);
    if (below && f.limit < 0) f.verdict = Verdict::broken;
    else if (proved) f.verdict = Verdict::proved;
    if (proved) return;
    f.hopeless = lane_of(select(hopeless_, Lane(1.0), Lane(0.0)), l) > 0.0;
    f.axis = cut_along(l, f.axis);
    if (!boxes_[l]->probe) probe(l, f);
  }

  /// sign C K C^T + factor C M C^T positive definite in all of a box?
  void prove(const FrameRows<Lane>& C, double sign, const Lane& factor, int count, bool (&proved)[Lane::lanes]) {
    hopeless_ = Lane(0.0) > 0.0;
    if constexpr (strays == 0) {
      form(A_, C, sign, factor);
    } else {
      MatrixModel<T> A;
      form(A, C, sign, factor);
      settle_strays(A);
    }
    test_(A_, count, proved);
  }
  void form(MatrixModel<T>& A, const FrameRows<Lane>& C, double sign, const Lane& factor) const {
    for (T& a : A.a) a = T(0.0);
    add_springs(A, C, directions_, sign, [this](int j) { return stiffness(j); });
    add_matrix(A, C, M_, factor);
    if (others_) add_matrix(A, C, K_, Lane(sign));
  }
  /// The matrix with what strays in its radii; whether these alone are too much at the centre.
  void settle_strays(const MatrixModel<T>& A) {
    Lane centre[symmetric_size];
    for (int r = 0; r < 6; ++r)
      for (int s = 0; s <= r; ++s) {
        const T& a = A.a[entry(r, s)];
        const Lane reach = a.norm(T::terms, T::count);
        centre[entry(r, s)] = r == s ? a.c[0] - reach : -(abs(a.c[0]) + reach);
        A_.a[entry(r, s)] = a.settled();
      }
    hopeless_ = !positive_definite(centre);
  }

  /// A corner where a diagonal entry of the matrix, without its radius, is negative: downhill by its linear terms.
  void probe(int l, Finding& f) const {
    constexpr const auto& m = monomials<n, 3>;
    for (int r = 0; r < 6 && !f.probe; ++r) {
      const Settled& a = A_.a[entry(r, r)];
      double u[n], value = 0.0;
      for (int i = 0; i < n; ++i) u[i] = lane_of(a.c[m.at(i)], l) > 0.0 ? -1.0 : 1.0;
      for (int k = 0; k < T::terms; ++k) {
        double term = lane_of(a.c[k], l);
        for (int i = 0; i < n; ++i) term *= m.power[k][i] % 2 ? u[i] : 1.0;
        value += term;
      }
      f.probe = value < 0.0;
      for (int i = 0; i < n; ++i) f.corner[i] = u[i] > 0.0 ? boxes_[l]->high[i] : boxes_[l]->low[i];
    }
  }

  /// Where the polynomial bends most.
  int cut_along(int l, int otherwise) const {
    constexpr const auto& m = monomials<n, 3>;
    double bend[n] = {};
    for (const Settled& a : A_.a)
      for (int k = m.first[2]; k < Settled::count; ++k) {
        const double size = std::abs(lane_of(a.c[k], l)) * (m.degree[k] == 2 ? 0.03 : 1.0);
        for (int i = 0; i < n; ++i) bend[i] += size * m.power[k][i];
      }
    int axis = otherwise;
    double most = 0.0;
    for (int i = 0; i < n; ++i)
      if (bend[i] > most && bend[i] < 1e300) most = bend[i], axis = i;
    return axis;
  }
};

}  // namespace flexapod
