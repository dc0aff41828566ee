#pragma once

#include <stdexcept>
#include <string>

namespace virtual_work_dynamics {

/// Base of everything that this library throws on bad input; what() is one line that names the
/// culprit.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The robot description is broken or asks for something unsupported.
class UrdfError : public Error {
 public:
  using Error::Error;
};

/// The scene is malformed, or names something that the mechanism does not have.
class SceneError : public Error {
 public:
  using Error::Error;
};

/// The loops of a scene cannot be closed from where its joints start.
class AssemblyError : public SceneError {
 public:
  using SceneError::SceneError;
};

/// What motions are said to give is too little or too much.
class GivenError : public SceneError {
 public:
  explicit GivenError(const std::string& problem)
      : SceneError("given: " + problem), problem_(problem) {}
  /// What is wrong, without the key of the scene.
  const std::string& problem() const { return problem_; }

 private:
  std::string problem_;
};

/// A motion has a wrong size, times in a wrong order or unusable values.
class MotionError : public Error {
 public:
  using Error::Error;
};

/// A file cannot be read, parsed or written.
class FileError : public Error {
 public:
  using Error::Error;
};

}  // namespace virtual_work_dynamics
