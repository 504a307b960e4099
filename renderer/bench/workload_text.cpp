// A table of statements; each number keeps its word, so that a mistake is told where it stands.
#include "renderer/bench/workload_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "renderer/scene/files/text_scan.h"
#include "renderer/scene/finite_number.h"

namespace marrow {
namespace {

constexpr double largest = 1e15;  // of every number of a scene, in scene units

struct Number {
  double value = 0;
  std::string_view word;
};

class WorkloadText {
 public:
  WorkloadText(std::string_view text, const std::string& name) : text_(text), problems_(text, name) {}

  Result<Workload> read() {
    Lines lines(text_);
    for (std::string_view line; !problems_.is_full() && lines.next(line);) read_line(line.substr(0, line.find('#')));
    if (problems_.none() && made_.size() == 0)
      problems_.complain_of_file("there is nothing to draw", "a line is `seg` or `pt` and numbers");
    if (problems_.none() && !has_camera_) look_at_all(made_);
    if (problems_.none() && eye_is_too_far(made_))
      problems_.complain_of_file("it is so large that an eye that sees all of it stands beyond 1e15 scene units",
                                 "say where the eye is with `cam`");
    if (!problems_.none()) return problems_.take();
    if (!has_light_) made_.toward_light = creature().toward_light;
    return std::move(made_);
  }

 private:
  struct Statement {
    std::string_view keyword;
    std::size_t least, most;  // numbers
    const char* form;
    void (WorkloadText::*take)(const Number* numbers, const char* place);
  };
  static constexpr std::size_t most_numbers = 9;
  static const std::array<Statement, 4> statements;

  void read_line(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword.empty()) return;
    const auto* s = std::ranges::find(statements, keyword, &Statement::keyword);
    if (s == statements.end())
      return problems_.complain(keyword, quoted_word(keyword) + " is not a statement",
                                "a line begins with cam, light, seg or pt");
    std::array<Number, most_numbers> numbers{};
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++count) {
      if (count == s->most) return problems_.complain(word, "there are too many numbers", s->form);
      const auto number = finite_number(word);
      if (!number) return problems_.complain(word, quoted_word(word) + " is not a finite number", s->form);
      if (std::fabs(*number) > largest)
        return problems_.complain(word, quoted_word(word) + " is too large",
                                  "nothing in a scene may be larger than 1e15");
      numbers[count] = {*number, word};
    }
    if (count < s->least) return problems_.complain(keyword, fmt::format("found {} numbers", count), s->form);
    (this->*s->take)(numbers.data(), keyword.data());
  }

  static Vec3d vec(const Number* n) { return {n[0].value, n[1].value, n[2].value}; }

  void take_once(bool& has, const char* place) {
    if (std::exchange(has, true)) problems_.complain(place, "there is a second one", "one is taken");
  }
  void take_camera(const Number* n, const char* place) {
    take_once(has_camera_, place);
    made_.eye = vec(n);
    made_.tan_half_fov = n[3].value;
    if (eye_is_too_far(made_))
      problems_.complain(n[2].word, "the eye looks beyond 1e15 scene units",
                         "nothing in a scene may be larger than 1e15");
    // As `fov` of a scene's camera
    if (!(made_.fov_deg() >= 0.001 && made_.fov_deg() <= 179))
      problems_.complain(n[3].word, quoted_word(n[3].word) + " is no tangent of half an angle of view",
                         "a number from 8.73e-06 to 114.58, for angles from 0.001 to 179 degrees");
  }
  void take_light(const Number* n, const char* place) {
    take_once(has_light_, place);
    if (vec(n) == Vec3d{}) return problems_.complain(place, "the sun stands nowhere", "a direction other than 0 0 0");
    made_.toward_light = normalize(vec(n));
  }
  void check_positive(const Number& n, const char* what) {
    if (!(n.value > 0))
      problems_.complain(n.word, fmt::format("the {} {} is not above 0", what, quoted_word(n.word)),
                         fmt::format("a {} is above 0", what));
  }
  void check_strength(const Number& n) {
    if (!n.word.empty()) check_positive(n, "strength");
  }
  void take_segment(const Number* n, const char* place) {
    check_positive(n[3], "radius");
    check_positive(n[7], "radius");
    check_strength(n[8]);
    if (vec(n) == vec(n + 4))
      return problems_.complain(place, "the segment has no length", "two ends that differ, or `pt`");
    made_.segments.push_back({vec(n), vec(n + 4), n[3].value, n[7].value});
  }
  void take_point(const Number* n, const char*) {
    check_positive(n[3], "radius");
    check_strength(n[4]);
    made_.points.push_back({vec(n), n[3].value});
  }

  std::string_view text_;
  FileProblems problems_;
  Workload made_;
  bool has_camera_ = false, has_light_ = false;
};

const std::array<WorkloadText::Statement, 4> WorkloadText::statements{{
    {"cam", 4, 4, "cam x y z t, with t the tangent of half the angle of view", &WorkloadText::take_camera},
    {"light", 3, 3, "light x y z, towards the sun", &WorkloadText::take_light},
    {"seg", 8, 9, "seg x y z r x y z r, then perhaps a strength", &WorkloadText::take_segment},
    {"pt", 4, 5, "pt x y z r, then perhaps a strength", &WorkloadText::take_point},
}};

}  // namespace

Result<Workload> read_workload_text(std::string_view bytes, const std::string& name) {
  return WorkloadText(bytes, name).read();
}

void look_at_all(Workload& w) {
  constexpr double around = 1.05;
  w.tan_half_fov = 0.2;
  const Box3 box = w.bounds();
  const double half = std::max(box.size().x, box.size().y) / 2;
  w.eye = box.center() + Vec3d{0, 0, box.size().z / 2 + std::max(half, box.size().z / 2) * around / w.tan_half_fov};
}

bool eye_is_too_far(const Workload& w) {
  return !(max_component(abs(w.eye)) <= largest && max_component(abs(w.looked_at())) <= largest);
}

}  // namespace marrow
