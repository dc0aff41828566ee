#include "scene/yaml_document.h"

#include <yaml-cpp/eventhandler.h>

#include <cstddef>
#include <sstream>
#include <unordered_map>
#include <vector>

#include "virtual_work_dynamics/error.h"

namespace virtual_work_dynamics {
namespace {

constexpr int kMostDocuments = 2;  // enough to know that there are several

/// Counts what a text holds before any of it is kept.
class Bounds : public YAML::EventHandler {
 public:
  int documents() const { return documents_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (documents_ > 0 && mark.pos == document_.pos)
      throw YAML::ParserException(mark, "nothing can begin with what is here");
    document_ = mark;
    ++documents_;
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { addValue(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string&) override {
    addValue(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, sizes_.count(anchor) > 0 ? sizes_[anchor] : 1);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YAML::anchor_t anchor;
    std::size_t size_before;
  };

  void add(const YAML::Mark& mark, std::size_t values) {
    size_ += values;
    if (size_ > kMostYamlValues) throw YAML::ParserException(mark, "more than a million values");
  }
  void addValue(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, 1);
    if (anchor != 0) sizes_[anchor] = 1;
  }
  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    open_.push_back({anchor, size_});
    if (open_.size() > kDeepestYaml)
      throw YAML::ParserException(mark,
                                  "nested more than " + std::to_string(kDeepestYaml) + " deep");
    add(mark, 1);
  }
  void close() {
    if (open_.back().anchor != 0) sizes_[open_.back().anchor] = size_ - open_.back().size_before;
    open_.pop_back();
  }

  int documents_ = 0;
  YAML::Mark document_;
  std::size_t size_ = 0;
  std::vector<Open> open_;
  std::unordered_map<YAML::anchor_t, std::size_t> sizes_;  // of what anchors stand for
};

}  // namespace

YAML::Node readYamlDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Bounds bounds;
  // One more than that shows whether the parser reads on.
  while (bounds.documents() <= kMostDocuments && parser.HandleNextDocument(bounds)) {
  }
  if (bounds.documents() > 1) throw SceneError("holds more than one YAML document");
  return bounds.documents() == 0 ? YAML::Node() : YAML::Load(text);
}

}  // namespace virtual_work_dynamics
