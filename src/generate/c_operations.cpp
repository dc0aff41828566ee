#include "generate/c_operations.h"

#include "generate/c_names.h"

namespace virtual_work_dynamics {

OperationWriter::OperationWriter(const std::string& name, const RecordedPlan& recording, bool packs)
    : name_(name),
      capitals_(inCapitals(name)),
      recording_(recording),
      packs_(packs),
      outputs_of_(recording.graph.nodes().size()) {
  for (const GraphOutput& output : recording.graph.outputs) {
    if (output.value.isNode()) outputs_of_[output.value.node()].push_back(&output);
  }
}

void OperationWriter::start() {
  out_.clear();
  defined_.assign(recording_.graph.nodes().size(), false);
}

std::string OperationWriter::constant(double value) const {
  return packs_ ? name_ + "_pack_all(" + cNumber(value) + ")" : cNumber(value);
}

// Number `index` of an array of inputs or results.
std::string OperationWriter::element(const std::string& array, int index) const {
  const std::string at = std::to_string(index);
  return packs_ ? array + " + " + at + " * stride" : array + "[" + at + "]";
}

void OperationWriter::define(std::uint32_t node, const std::string& value) {
  out_ += "  const " + (packs_ ? name_ + "_pack" : std::string("double")) + " x" +
          std::to_string(node) + " = " + value + ";\n";
  defined_[node] = true;
}

void OperationWriter::leaf(std::uint32_t index) {
  const Node& node = recording_.graph.nodes()[index];
  const std::string at = std::to_string(node.index);
  if (node.operation == Operation::kAngle) {
    static const char* const kArrays[] = {"cosine", "sine", "rest"};
    return define(index, kArrays[node.array] + ("[" + at + "]"));
  }
  const std::string from =
      element(recording_.inputs[static_cast<std::size_t>(node.array)].name, node.index);
  define(index, packs_ ? "*(const " + name_ + "_pack_at *)(" + from + ")" : from);
}

std::string OperationWriter::text(const Term& term) {
  if (!term.isNode()) return constant(term.value());
  if (!defined_[term.node()]) leaf(term.node());
  return "x" + std::to_string(term.node());
}

std::string OperationWriter::spelling(const Node& node) {
  const int operands = operandsOf(node);
  const std::string a = text(node.a), b = operands > 1 ? text(node.b) : "",
                    c = operands > 2 ? text(node.c) : "";
  const auto fused = [&](const char* minus_a, const char* minus_c, const char* of_packs) {
    if (packs_) return name_ + "_pack_" + of_packs + "(" + a + ", " + b + ", " + c + ")";
    return capitals_ + "_FMA(" + minus_a + a + ", " + b + ", " + minus_c + c + ")";
  };
  switch (node.operation) {
    case Operation::kNegate:
      return "-" + a;
    case Operation::kAdd:
      return a + " + " + b;
    case Operation::kSubtract:
      return a + " - " + b;
    case Operation::kMultiply:
      return a + " * " + b;
    case Operation::kMulAdd:
      return fused("", "", "fma");
    case Operation::kSubMul:
      return fused("-", "", "fnma");
    case Operation::kMulSub:
      return fused("", "-", "fms");
    case Operation::kMinusMulSub:
      return fused("-", "-", "fnms");
    case Operation::kProductRest:
      if (packs_) return name_ + "_exact_rest(" + a + ", " + b + ", " + c + ")";
      return capitals_ + "_EXACT_FMA(" + a + ", " + b + ", -" + c + ")";
    case Operation::kHeld:
      return name_ + (packs_ ? "_pack_held(" : "_held(") + a + ")";
    case Operation::kDivide:
      return a + " / " + b;
    case Operation::kRoot:
      return packs_ ? name_ + "_pack_root(" + a + ")" : capitals_ + "_ROOT(" + a + ")";
    case Operation::kAwayFrom:
      return selected("less", a, constant(0), b, "-" + b);
    case Operation::kLarger:
      return selected("less", b, a, a, b);
    case Operation::kPositive:
      return selected("less", constant(0), a, b, c);
    case Operation::kUnlessAbove:
      return selected("less", b, a, constant(0), constant(1));
    case Operation::kUnlessAtMost:
      return selected("at_most", a, b, constant(0), constant(1));
    case Operation::kInput:
    case Operation::kAngle:
      break;
  }
  return "";
}

// What is chosen by a < b, or by a <= b.
std::string OperationWriter::selected(const std::string& by, const std::string& a,
                                      const std::string& b, const std::string& then,
                                      const std::string& otherwise) const {
  if (packs_) {
    return name_ + "_pack_" + by + "(" + a + ", " + b + ", " + then + ", " + otherwise + ")";
  }
  return "(" + a + (by == "less" ? " < " : " <= ") + b + ") ? " + then + " : " + otherwise;
}

void OperationWriter::assign(const std::string& to, const std::string& value) {
  out_ += packs_ ? "  " + name_ + "_pack_store(" + to + ", " + value + ");\n"
                 : "  " + to + " = " + value + ";\n";
}

void OperationWriter::operation(std::uint32_t node) {
  if (isLeaf(recording_.graph.nodes()[node])) return;
  const std::string value = spelling(recording_.graph.nodes()[node]);
  define(node, value);
}

std::string OperationWriter::part(const ProgramPart& part, bool last) {
  start();
  const auto outputName = [&](const GraphOutput& output) {
    return element(recording_.outputs[static_cast<std::size_t>(output.array)].name, output.index);
  };
  for (const Kept& kept : part.taken) define(kept.node, "m[" + std::to_string(kept.slot) + "]");
  for (const std::uint32_t node : part.nodes) {
    operation(node);
    for (const GraphOutput* output : outputs_of_[node]) {
      assign(outputName(*output), "x" + std::to_string(node));
    }
  }
  for (const Kept& kept : part.kept) {
    out_ += "  m[" + std::to_string(kept.slot) + "] = x" + std::to_string(kept.node) + ";\n";
  }
  for (const GraphOutput& output : recording_.graph.outputs) {
    const bool read =
        output.value.isNode() && !isLeaf(recording_.graph.nodes()[output.value.node()]);
    if (!last || read) continue;
    const std::string value = text(output.value);
    assign(outputName(output), value);
  }
  return out_;
}

std::string OperationWriter::angles() {
  start();
  for (const std::uint32_t node : nodesOfAngles(recording_.graph)) operation(node);
  const std::vector<Angle>& angles = recording_.graph.angles();
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const std::string angle = text(angles[i].angle);
    if (packs_) out_ += "  angle[" + std::to_string(i) + "] = " + angle + ";\n";
    if (!recording_.anyRest()) continue;
    const std::string rest = text(angles[i].rest);
    out_ += "  rest[" + std::to_string(i) + "] = " + rest + ";\n";
  }
  if (!packs_) sines();
  return out_;
}

// Eight at a time.
void OperationWriter::sines() {
  const std::vector<Angle>& angles = recording_.graph.angles();
  std::string list;
  for (std::size_t i = 0; i < angles.size(); i += 8) {
    out_ += i == 0 ? "  every = " : "  every &= ";
    out_ += name_ + "_sines(";
    for (std::size_t j = i; j < i + 8; ++j) {
      out_ += (j < angles.size() ? text(angles[j].angle) : constant(0)) + ", ";
    }
    const std::string at = std::to_string(i);
    out_ += "sine + " + at + ", cosine + " + at + ");\n";
  }
  for (const Angle& angle : angles) list += (list.empty() ? "" : ", ") + text(angle.angle);
  out_ += "  if (!every) {\n    const double angle[] = {" + list + "};\n    " + name_ +
          "_library_sines(" + std::to_string(angles.size()) + ", angle, " +
          (recording_.anyRest() ? "rest" : "0") + ", sine, cosine);\n  }\n";
}

}  // namespace virtual_work_dynamics
