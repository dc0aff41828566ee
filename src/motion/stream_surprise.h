#pragma once

namespace virtual_work_dynamics {

/// Judges from the innovations of a filter (a sample less what the filter foresaw of it) whether
/// its model still holds. Keeps the mean of their squares, which is one where the model holds, and
/// that of the products of successive ones, which is near the squares where the motion is quicker
/// than the model and negative where the noise is larger. Does not allocate.
class StreamSurprise {
 public:
  enum class Verdict {
    kNothing,  ///< the samples are about as the model foresees them
    kQuicker,  ///< the motion changes faster than the model lets it
    kNoisier,  ///< the samples are worse than the model says
    kJump      ///< two samples in a row are so far away that no motion led there
  };
  struct Finding {
    Verdict verdict = Verdict::kNothing;
    /// Squares of the innovations over their variances, as far as they are to be explained; one
    /// where there is nothing to explain.
    double factor = 1;
  };

  /// Takes the innovation of the next sample. Any verdict other than kNothing is given once: the
  /// means then begin anew.
  /// @param innovation in deviations that the model foresees, without unit.
  Finding take(double innovation);

  /// Forgets the innovations so far, for another stretch of samples or another model.
  void restart();

 private:
  double square_ = 1;   // mean square of the latest innovations
  double product_ = 0;  // mean product of each with the one before
  double previous_ = 0;
};

}  // namespace virtual_work_dynamics
