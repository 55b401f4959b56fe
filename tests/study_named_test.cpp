// Named studies without a device: the table, what judges say of results made by hand (both ways), tables, reports.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gi/study/claims.h"
#include "gi/study/named.h"
#include "gi/study/named_report.h"
#include "gi/study/report.h"
#include "gi/study/sweep.h"
#include "gi/study/thesis_tables.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"
#include "tests/support.h"

namespace irad::test::study_named_suite {
namespace {

namespace fs = std::filesystem;

/// What a made-up point has.
struct Made {
  std::map<std::string, std::string> settings;
  double relMse = .1, light = 1, ms = 100;
  double half = .001, rmse = .1, facets = 1000, matrixMib = 10;
};
/// An experiment of such points, whose truth's mean is 1; all stages take `ms`.
ExperimentResult experiment(const std::string& name, const std::vector<Made>& made) {
  ExperimentResult out;
  out.experiment.name = name;
  out.experiment.scene = name.substr(0, name.find('-'));
  out.figures["truth_mean"] = 1;
  for (const Made& m : made) {
    PointSummary p;
    p.point = out.points.size();
    for (const auto& [setting, value] : m.settings) p.label += setting + "=" + value;
    p.seeds = 3;
    p.relMse = {m.relMse, m.half}, p.rmse = {m.rmse, m.half}, p.meanError = {m.light - 1, m.half};
    p.psnr = {20, 1}, p.flip = {m.relMse, m.half};
    p.facets = m.facets, p.matrixMib = m.matrixMib;
    for (const auto& [kind, stage] : {std::pair("setup", "GI BuildMatrix"),
                                      {"relight", "GI Solve"},
                                      {"relight", "GI Scatter"},
                                      {"camera", "RE Forward"}}) {
      p.stages[kind][stage] = {m.ms, m.ms, m.ms, 5};
      p.gpu[kind] = {m.ms, m.ms, m.ms, 5};
    }
    out.points.push_back({m.settings, p});
  }
  return out;
}
NamedResults results(std::vector<ExperimentResult> experiments, bool full = true) {
  return {.experiments = std::move(experiments), .cpu = false, .full = full};
}
Judgement verdict(Answer (*judge)(const NamedResults&), const NamedResults& r) {
  const Answer answer = answerTo({"T", "said", judge}, r);
  EXPECT_FALSE(answer.text.empty());
  EXPECT_FALSE(contains(answer.text, " nan") || contains(answer.text, " inf")) << answer.text;
  return answer.verdict;
}
constexpr Judgement kYes = Judgement::Agrees, kNo = Judgement::Disagrees, kAnswered = Judgement::Answered,
                    kOpen = Judgement::Open;

TEST(NamedStudies, HaveExperimentsThatExistAndAreNotTheSameFolder) {
  std::set<std::string> names;
  for (const NamedStudy& study : namedStudies()) {
    EXPECT_TRUE(names.insert(study.name).second) << study.name;
    EXPECT_EQ(findNamedStudy(study.name), &study);
    for (const StudyScale& scale : studyScales()) {
      std::set<std::string> folders;
      for (const Experiment& e : study.experiments(scale)) {
        EXPECT_TRUE(folders.insert(e.name).second) << study.name << " " << e.name;
        for (const std::string& text : e.settings)
          if (!text.starts_with("preset=")) {
            EXPECT_NO_THROW((void)findSetting(text.substr(0, text.find('='))));
          }
        for (const auto& sweeps : e.grids)
          for (const std::string& sweep : sweeps) EXPECT_NO_THROW((void)findSetting(sweep.substr(0, sweep.find('='))));
      }
      EXPECT_FALSE(folders.empty()) << study.name;
    }
  }
  for (int question = 1; question <= 12; ++question) EXPECT_TRUE(names.contains("rq" + std::to_string(question)));
  EXPECT_EQ(findScale("full").voxels, 256u) << "T Table 5";
  EXPECT_EQ(findScale("full").rays, 384u);
  EXPECT_EQ(findNamedStudy("rq13"), nullptr);
  try {
    (void)findScale("smal");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_TRUE(contains(error.what(), "--scale: unknown 'smal' (did you mean small?)")) << error.what();
  }
}

TEST(NamedStudies, SayWhatIsNotMeasured) {
  for (const NamedStudy& study : namedStudies())
    for (const Claim& claim : study.claims) {
      const Answer nothing = answerTo(claim, results({}));
      EXPECT_EQ(nothing.verdict, kOpen) << claim.said;
      EXPECT_TRUE(contains(nothing.text, "Not measured: ")) << nothing.text;
    }
  NamedResults r = results({experiment("box-thesis", {})});
  r.experiments[0].skipped = "no memory";
  const Answer answer = answerTo({"T", "", claims::timeIsCubicInResolution}, r);
  EXPECT_EQ(answer.text, "Not measured: box-thesis: no memory.");
}

TEST(NamedFits, AreThoseOfTheirCurves) {
  EXPECT_NEAR(exponentOf({{2, 8}, {4, 64}, {8, 512}}), 3, 1e-12);
  EXPECT_TRUE(std::isnan(exponentOf({{2, 8}})));
  const NoiseFit fit = fitNoise({{16, 2 + 8. / 16}, {32, 2 + 8. / 32}, {64, 2 + 8. / 64}});
  EXPECT_NEAR(fit.bias, 2, 1e-12);
  EXPECT_NEAR(fit.noiseShare(16), .5 / 2.5, 1e-12);
  const auto parabola = [](double x) { return std::pair(x, (x - .73) * (x - .73)); };
  EXPECT_NEAR(leastAt({parabola(.5), parabola(.6), parabola(.7), parabola(.8), parabola(1)}), .73, 1e-12);
  EXPECT_EQ(leastAt({{.5, 3}, {.9, 2}, {1, 1}}), 1) << "an end is the least";
  EXPECT_EQ(compare({1, .1}, {1.15, .1}), IntervalOrder::Equal);
  EXPECT_EQ(compare({1, .1}, {1.3, .1}), IntervalOrder::Less);
  EXPECT_EQ(compare({1, HUGE_VAL}, {1.3, .1}), IntervalOrder::Unknown) << "one seed";
}

TEST(Judges, OfBruteForce) {
  const auto with = [](double bruteLight, double oneBounce) {
    return results(
        {experiment("box-thesis", {{{{"solver.method", "matrix"}, {"solver.max_sweeps", "1000"}}},
                                   {{{"solver.method", "matrix"}, {"solver.max_sweeps", "1"}}, .1, oneBounce},
                                   {{{"solver.method", "brute_force"}, {"solver.frames", "1"}}, .1, .8},
                                   {{{"solver.method", "brute_force"}, {"solver.frames", "256"}}, .1, bruteLight}})});
  };
  EXPECT_EQ(verdict(claims::bruteForceDiffers, with(.8, .7)), kYes);
  EXPECT_EQ(verdict(claims::bruteForceDiffers, with(1.005, .7)), kNo);
  EXPECT_EQ(verdict(claims::bruteForceLosesBounces, with(1, .7)), kYes);
  EXPECT_EQ(verdict(claims::bruteForceLosesBounces, with(1, .97)), kNo);
}

TEST(Judges, OfTimesSpeakOnlyOfGpusAtFullSize) {
  const auto with = [](double thesis, double ours, bool full = true) {
    return results({experiment("box-thesis", {{{}, .1, 1, thesis}}), experiment("box-ours", {{{}, .1, 1, ours}})},
                   full);
  };
  EXPECT_EQ(verdict(claims::buildTakesSeconds, with(5000, 1)), kYes);
  EXPECT_EQ(verdict(claims::buildTakesSeconds, with(900, 1)), kNo);
  EXPECT_EQ(verdict(claims::buildTakesSeconds, with(900, 1, false)), kOpen);
  EXPECT_EQ(verdict(claims::buildTakesLongerThanAFrame, with(900, 1)), kYes);
  EXPECT_EQ(verdict(claims::buildTakesLongerThanAFrame, with(9, 1)), kNo);
  NamedResults cpu = with(900, 1);
  cpu.cpu = true;
  EXPECT_EQ(verdict(claims::buildTakesLongerThanAFrame, cpu), kOpen);

  const auto relight = [](double ms, bool full = true) {
    const std::map<std::string, std::string> one{{"solver.max_sweeps", "1"}}, all{{"solver.max_sweeps", "1000"}};
    return results({experiment("box-thesis", {{one, .1, 1, ms}, {all, .1, 1, 9}}),
                    experiment("box-ours", {{one, .1, 1, 1}, {all, .1, 1, 2}})},
                   full);
  };
  EXPECT_EQ(verdict(claims::relightTakesTwoToFourMs, relight(3)), kYes);
  EXPECT_EQ(verdict(claims::relightTakesTwoToFourMs, relight(.4)), kNo);
  EXPECT_EQ(verdict(claims::relightTakesTwoToFourMs, relight(3, false)), kOpen);
}

TEST(Judges, OfResolution) {
  const auto with = [](double power, double error) {
    std::vector<Made> points;
    for (const double n : {128.0, 256.0, 384.0})
      points.push_back({{{"voxel.resolution", std::to_string(static_cast<int>(n))}},
                        .1 * std::pow(n / 384, -error),
                        1,
                        std::pow(n, power),
                        .001,
                        .1,
                        n * n,
                        std::pow(n, power)});
    return results({experiment("box-thesis", points)});
  };
  EXPECT_EQ(verdict(claims::timeIsCubicInResolution, with(3, 0)), kYes);
  EXPECT_EQ(verdict(claims::timeIsCubicInResolution, with(2, 0)), kNo);
  EXPECT_EQ(verdict(claims::matrixIsCubicInResolution, with(3, 0)), kYes);
  EXPECT_EQ(verdict(claims::matrixIsCubicInResolution, with(2, 0)), kNo);
  EXPECT_EQ(verdict(claims::resolutionIsSubtle, with(3, .2)), kYes);
  EXPECT_EQ(verdict(claims::resolutionIsSubtle, with(3, 1)), kNo);
}

TEST(Judges, OfRows) {
  const auto with = [](double power, double hard, double average) {
    const auto rows = [&](const char* name, double noise) {
      std::vector<Made> points;
      for (const double n : {128.0, 256.0, 384.0})
        points.push_back({{{"matrix.rays", std::to_string(static_cast<int>(n))}},
                          std::sqrt(.01 + noise / n),
                          1,
                          std::pow(n, power),
                          .0001,
                          std::sqrt(.01 + noise / n)});
      return experiment(name, points);
    };
    return results({rows("hard-thesis", hard), rows("average-thesis", average)});
  };
  EXPECT_EQ(verdict(claims::timeIsLinearInRows, with(1, 1, .01)), kYes);
  EXPECT_EQ(verdict(claims::timeIsLinearInRows, with(.3, 1, .01)), kNo);
  EXPECT_EQ(verdict(claims::rowsQuietHardLight, with(1, 1, .01)), kYes);
  EXPECT_EQ(verdict(claims::rowsQuietHardLight, with(1, .0001, .01)), kNo);
  EXPECT_EQ(verdict(claims::rowsDoLittleInAverageLight, with(1, 1, .01)), kYes);
  EXPECT_EQ(verdict(claims::rowsDoLittleInAverageLight, with(1, 1, 2)), kNo);
  const Answer noise = claims::rowsQuietHardLight(with(1, 1.28, .01));
  EXPECT_TRUE(contains(noise.text, "50 % of it is noise at 128")) << noise.text;
}

TEST(Judges, OfTraversal) {
  const auto with = [](double jfaMs, double jfaError, double moved, double movedExactly) {
    ExperimentResult e =
        experiment("box-thesis", {{{{"matrix.traversal", "dda"}, {"field.method", "jfa"}}, .1, 1, 100},
                                  {{{"matrix.traversal", "sdf"}, {"field.method", "jfa"}}, jfaError, 1.1, jfaMs},
                                  {{{"matrix.traversal", "sdf"}, {"field.method", "chebyshev"}}, .1, 1, 40}});
    e.figures["moved 1"] = moved, e.figures["moved 2"] = movedExactly;
    return results({e});
  };
  EXPECT_EQ(verdict(claims::sdfIsTwiceAsFast, with(50, .1, 0, 0)), kYes);
  EXPECT_EQ(verdict(claims::sdfIsTwiceAsFast, with(99, .1, 0, 0)), kNo);
  NamedResults small = with(50, .1, 0, 0);
  small.full = false;
  EXPECT_EQ(verdict(claims::sdfIsTwiceAsFast, small), kOpen) << "small sizes say little of how times grow";
  EXPECT_EQ(verdict(claims::sdfLosesNoQuality, with(50, .1005, 0, 0)), kYes);
  EXPECT_EQ(verdict(claims::sdfLosesNoQuality, with(50, .2, 0, 0)), kNo);
  EXPECT_EQ(verdict(claims::sdfWeakensShadows, with(50, .1, .5, .0001)), kAnswered);
  EXPECT_EQ(verdict(claims::sdfWeakensShadows, with(50, .1, .5, .4)), kOpen) << "then it is not the field's bytes";
}

TEST(Judges, OfNormals) {
  const auto with = [](double axis6, double axis26, double oct8) {
    const std::vector<Made> points{{{{"voxel.normals", "axis6"}}, axis6},
                                   {{{"voxel.normals", "axis26"}}, axis26},
                                   {{{"voxel.normals", "oct8"}}, oct8}};
    return results({experiment("box-thesis", points), experiment("curved-thesis", points)});
  };
  EXPECT_EQ(verdict(claims::normalsMatterLittle, with(.11, .1, .1)), kYes);
  EXPECT_EQ(verdict(claims::normalsMatterLittle, with(.2, .1, .1)), kNo);
  EXPECT_EQ(verdict(claims::octahedralIsBetterOnCurves, with(.2, .1, .09)), kYes);
  EXPECT_EQ(verdict(claims::octahedralIsBetterOnCurves, with(.2, .1, .1005)), kNo);
  const auto voxels = [](double raster, double whole) {
    return results(
        {experiment("voxels-thesis",
                    {{{{"voxel.method", "raster"}, {"thesis.literal", "false"}}, .1, 1, 100, .001, .1, raster},
                     {{{"voxel.method", "conservative"}, {"thesis.literal", "false"}}, .1, 1, 100, .001, .1, whole},
                     {{{"voxel.method", "raster"}, {"thesis.literal", "true"}}, .1, 1, 100, .001, .1, raster}})});
  };
  EXPECT_EQ(verdict(claims::voxelsAreMissing, voxels(900, 1000)), kAnswered);
  EXPECT_EQ(verdict(claims::voxelsAreMissing, voxels(1000, 1000)), kOpen);
}

TEST(Judges, OfRelaxation) {
  const auto scene = [](const char* name, double best) {
    std::vector<Made> points;
    for (const char* lambda : {"0.5", "0.6", "0.7", "0.8", "0.9", "1"})
      points.push_back({{{"solver.lambda", lambda}}, .1 + std::pow(std::stod(lambda) - best, 2)});
    return experiment(name, points);
  };
  EXPECT_EQ(verdict(claims::bestLambda, results({scene("box-thesis", .75), scene("park-thesis", .85)})), kYes);
  EXPECT_EQ(verdict(claims::bestLambda, results({scene("box-thesis", .75), scene("park-thesis", 1)})), kNo);
  const Answer normalized =
      claims::bestLambdaOfNormalizedRows(results({scene("box-thesis", .75), scene("box-ours", 1)}));
  EXPECT_EQ(normalized.verdict, kAnswered);
  EXPECT_TRUE(contains(normalized.text, "the physics' own value, 1, is the best")) << normalized.text;
  EXPECT_TRUE(
      contains(claims::bestLambdaOfNormalizedRows(results({scene("box-thesis", .75), scene("box-ours", .8)})).text,
               "Even there it is not 1"));
}

TEST(Judges, OfSampling) {
  const auto with = [](double best, double linear, double lightWithout) {
    const auto made = [](const char* filter, const char* premultiplied, double error, double light) {
      return Made{{{"sample.filter", filter}, {"sample.premultiplied", premultiplied}}, error, light};
    };
    return results(
        {experiment("box-thesis", {made("linear", "false", .3, lightWithout), made("linear", "true", linear, 1),
                                   made("blur", "false", .3, lightWithout), made("blur", "true", best, 1)})});
  };
  EXPECT_EQ(verdict(claims::blurPremultipliedIsBest, with(.1, .2, .5)), kYes);
  EXPECT_EQ(verdict(claims::blurPremultipliedIsBest, with(.1, .05, .5)), kNo);
  EXPECT_EQ(verdict(claims::premultiplyingMendsEdges, with(.1, .2, .5)), kYes);
  EXPECT_EQ(verdict(claims::premultiplyingMendsEdges, with(.1, .2, 1)), kNo);
}

TEST(Judges, OfEdges) {
  const auto with = [](double error, double reflections) {
    const std::map<std::string, std::string> off{{"scatter.edge_removal", "false"}},
        on{{"scatter.edge_removal", "true"}};
    return results({experiment("box-thesis", {{off, .1}, {on, error}}),
                    experiment("reflections", {{off}, {on, .1, reflections}})});
  };
  EXPECT_EQ(verdict(claims::edgeRemovalMendsEdges, with(.05, 1)), kYes);
  EXPECT_EQ(verdict(claims::edgeRemovalMendsEdges, with(.1, 1)), kNo);
  EXPECT_EQ(verdict(claims::edgeRemovalTime, with(.1, 1)), kAnswered);
  EXPECT_EQ(verdict(claims::edgeRemovalDarkensReflections, with(.1, .8)), kYes);
  EXPECT_EQ(verdict(claims::edgeRemovalDarkensReflections, with(.1, 1)), kNo);
}

TEST(Judges, OfWriteback) {
  const auto with = [](double maskMs, double flicker, double light) {
    ExperimentResult e = experiment("box-thesis", {{{{"writeback.mode", "off"}}, .1, 1, 1},
                                                   {{{"writeback.mode", "mask"}}, .1, light, maskMs},
                                                   {{{"writeback.mode", "compute"}}, .1, 1.1, 1}});
    e.figures["flicker 1"] = flicker, e.figures["flicker 2"] = 0;
    return results({e});
  };
  EXPECT_EQ(verdict(claims::writebackCostsAMultiple, with(9, .1, 1)), kYes);
  EXPECT_EQ(verdict(claims::writebackCostsAMultiple, with(1.1, .1, 1)), kNo);
  EXPECT_EQ(verdict(claims::writebackFlickers, with(1, .1, 1)), kYes);
  EXPECT_EQ(verdict(claims::writebackFlickers, with(1, 0, 1)), kNo);
  EXPECT_EQ(verdict(claims::writebackAddsLittle, with(1, 0, 1.01)), kYes);
  EXPECT_EQ(verdict(claims::writebackAddsLittle, with(1, 0, 1.3)), kNo);
}

TEST(Judges, OfBlender) {
  const auto lit = [](const char* name, double light, double flip) {
    ExperimentResult e = experiment(name, {{{}, flip, light}});
    e.experiment.view = "lit";
    return e;
  };
  EXPECT_EQ(verdict(claims::cyclesIsMatched, results({lit("sponza-thesis", 1.05, .1), lit("sponza-ours", 2, .1)})),
            kYes);
  EXPECT_EQ(verdict(claims::cyclesIsMatched, results({lit("sponza-thesis", .7, .1)})), kNo);
  // Ours to Cycles; EEVEE's to Cycles, and the share of its light.
  const auto both = [&](double ours, double eevee, double share) {
    std::vector<ExperimentResult> out;
    for (const char* scene : {"box", "park"}) {
      out.push_back(lit(fmt::format("{}-cycles-lit", scene).c_str(), 1, ours));
      out.push_back(lit(fmt::format("{}-eevee-lit", scene).c_str(), 1, .2));
      out.back().figures["truth_mean"] = share, out.back().figures["cycles_mean"] = 1;
      out.back().figures["cycles_flip"] = eevee;
    }
    return results(std::move(out));
  };
  EXPECT_EQ(verdict(claims::eeveeIsFarOff, both(.1, .3, .2)), kYes);
  EXPECT_EQ(verdict(claims::eeveeIsFarOff, both(.3, .1, .2)), kNo);
  EXPECT_EQ(verdict(claims::eeveeIsFarOff, both(.1, .3, .95)), kNo) << "not dark";
  EXPECT_EQ(verdict(claims::cyclesIsMatched, both(.1, .3, .2)), kYes);
}

TEST(ThesisTables, HoldWhatWasPublishedBesideWhatIsMeasured) {
  const std::vector<TimeRow> here{{0, 0, "setup", "GI BuildMatrix", 100},
                                  {0, 1, "setup", "GI BuildMatrix", 300},
                                  {1, 0, "setup", "GI BuildMatrix", 9000},
                                  {0, 0, "relight", "GI Solve Emitters", 70}};
  const TextTable box = timeTable(9, here);
  bool found = false;
  for (const auto& row : box) {
    ASSERT_EQ(row.size(), box[0].size());
    if (row[0] != "GI BuildMatrix matrixconstruction") continue;
    found = true;
    EXPECT_EQ(row[1], "957.9435") << "T Table 9";
    EXPECT_EQ(row[9], "GI BuildMatrix");
    EXPECT_EQ(row[10], "200.0000") << "of point 0 alone";
    EXPECT_EQ(row[18], "0.21");
  }
  EXPECT_TRUE(found);
  EXPECT_EQ(box.size(), 13u);
  for (const auto& row : box)
    if (row[0] == "GI Iteration Jacobi") {
      EXPECT_EQ(row[10], "") << "GI Solve Emitters is another stage";
    }

  ExperimentResult e = experiment("box", {{}});
  e.figures.insert({{"extent x", 10.65}, {"extent y", 10.65}, {"extent z", 5.325}, {"vertices", 5}});
  const TextTable extents = extentTable(results({e})), geometry = geometryTable(results({e}));
  EXPECT_EQ(extents.at(8)[5], "256x256x128");
  EXPECT_EQ(extents.at(8)[8], "1");
  EXPECT_EQ(extents.at(1)[5], "") << "the park was not measured";
  EXPECT_EQ(geometry.at(3)[2], "5");
  EXPECT_EQ(csvOf({{"a", "b,c"}}), "a,\"b,c\"\n");
  EXPECT_EQ(publishedMebibytes("matrixHits"), "3072.00");
}

TEST(NamedReports, AreWholeAndStandByThemselves) {
  TemporaryFolder folder;
  const glm::uvec2 size(48, 32);
  const fs::path own = folder.path / "box-thesis";
  fs::create_directories(own / "pictures");
  for (const std::string& name : {std::string(kReferenceName), pictureName(0), pictureName(1)})
    writeDisplay(own / "pictures" / name, size, std::vector<glm::u8vec4>(48 * 32, {90, 120, 200, 255}));
  writeFile(own / "notes.json",
            R"({"facts": ["Scene <box>"], "picture": [48, 32], "crop": [8, 8], "crop_size": [24, 16]})");
  NamedReport report{findNamedStudy("rq4"),
                     results({experiment("box-thesis", {{{{"voxel.resolution", "128"}}, .1, 1, 10},
                                                        {{{"voxel.resolution", "256"}}, .05, 1, 80}}),
                              experiment("sponza-thesis", {})}),
                     {"Device: <x>"}};
  report.results.experiments[1].skipped = "no Sponza";
  writeNamedReport(folder.path, report);
  const std::string html = slurp(folder.path / "report.html");
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_TRUE(contains(html, "Skipped: no Sponza."));
  EXPECT_TRUE(contains(html, "grows as N^3.00"));
  // A sentence before each plot, of its figures (nobody has timed a first solve here).
  for (const char* sentence : {"First picture: nothing was measured.",
                               "Build: 10 ms at point 0, 100 % of it GI BuildMatrix; 80 ms at point 1, 100 % of it GI "
                               "BuildMatrix.",
                               "Relight: 10 ms at point 0, 100 % of it GI Scatter; ", "Frame: 10 ms at point 0, "})
    EXPECT_TRUE(contains(html, std::string("<p class=\"finding\">") + sentence)) << sentence;
  EXPECT_TRUE(contains(html, "<td class=\"agrees\">agrees</td>") && contains(html, "<td class=\"disagrees\">"));
  EXPECT_FALSE(contains(html, "<script") || contains(html, "src=\"") || contains(html, "href=\"http"));
  if (fs::exists(own / "pictures/reference.png")) {
    size_t pictures = 0;
    for (size_t at = 0; (at = html.find("href=\"data:image/png;base64,iVBORw0KGgo", at)) != std::string::npos; ++at)
      ++pictures;
    EXPECT_EQ(pictures, 3u) << "the truth and both points";
  }
  EXPECT_TRUE(contains(slurp(folder.path / "findings.csv"), "rq4,7.6,"));

  report.tables = {{"Table 3: geometry", {{"a", "b"}, {"1", "2"}}}};
  writeThesisReport(folder.path, {report});
  EXPECT_EQ(slurp(folder.path / "table-3.csv"), "a,b\n1,2\n");
  EXPECT_TRUE(contains(slurp(folder.path / "report.html"), "href=\"rq4/report.html\""));
}

}  // namespace
}  // namespace irad::test::study_named_suite
