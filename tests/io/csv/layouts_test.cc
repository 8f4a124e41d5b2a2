// The same directions in the layouts of scatterometers, spreadsheets and computer graphics.
#include "tests/io/csv/read_csv.h"

namespace lobefit {
namespace {

// theta_i 30 degrees, viewers at -20 and 45 degrees of the plane: (20, 0) and (45, 180).
void ExpectTheTwo(const Measurement& m) {
  ASSERT_EQ(m.samples.size(), 2U);
  ExpectSample(m, 0, 30, 0, 20, 0, 0.5);
  ExpectSample(m, 1, 30, 0, 45, 180, 0.25);
}

TEST(CsvLayouts, TheLightStatedInTheHead) {
  ExpectTheTwo(ReadText("# AOI: 30 deg\ntheta_s,BSDF\n-20,0.5\n45,0.25\n"));
  ExpectTheTwo(ReadText("AOI;30;deg\ntheta_s;BSDF\n-20;0,5\n45;0,25\n"));
  ExpectTheTwo(ReadText("# theta_i = 0.5235987755982988 rad\nangle,BSDF\n-20,0.5\n45,0.25\n"));
  ReadOptions options;
  options.keys = {"theta_i=30"};
  ExpectTheTwo(ReadText("theta_s,BSDF\n-20,0.5\n45,0.25\n", options));
  const Measurement wavelength = ReadText("# AOI: 30 deg\n# wavelength: 633 nm\ntheta_s,BSDF\n-20,0.5\n45,0.25\n");
  EXPECT_EQ(wavelength.channels.wavelengths_nm, (std::vector<double>{633}));
}

TEST(CsvLayouts, OffsetsFromTheMirrorDirection) {
  ExpectTheTwo(ReadText("AOI,delta_theta,BSDF\n30,-50,0.5\n30,15,0.25\n"));
  ExpectTheTwo(ReadText("AOI,theta_s - theta_i,BSDF\n30,-50,0.5\n30,15,0.25\n"));
  ExpectTheTwo(ReadText("AOI,theta_i - theta_s,BSDF\n30,50,0.5\n30,-15,0.25\n"));
  const std::string betas = "-0.8420201433256687,0.5\n0.2071067811865476,0.25\n";
  ExpectTheTwo(ReadText("# AOI: 30\nbeta - beta0,BSDF\n" + betas));
  ExpectTheTwo(ReadText("# AOI: 30\nsin(theta_s)-sin(theta_i),BSDF\n" + betas));
  // Without a sign: towards the normal, where there always is a direction.
  const Measurement unsigned_offset = ReadText("AOI,|beta-beta0|,BSDF\n30,0.5,0.5\n30,0,0.25\n");
  ExpectSample(unsigned_offset, 0, 30, 0, 0, 0, 0.5);
  ExpectSample(unsigned_offset, 1, 30, 0, 30, 180, 0.25);
  // A beta beyond 1 is no direction.
  const Measurement beyond = ReadText("AOI,beta-beta0,BSDF\n30,0.6,0.5\n30,0,0.25\n");
  EXPECT_EQ(beyond.samples.size(), 1U);
  EXPECT_EQ(beyond.set_aside.total(), 1U);
}

TEST(CsvLayouts, AColumnForEachAngle) {
  const Measurement wide = ReadText("theta_s,AOI=10,AOI=30\n-20,1,0.5\n45,2,0.25\n");
  ASSERT_EQ(wide.samples.size(), 4U);
  ExpectSample(wide, 0, 10, 0, 20, 0, 1);
  ExpectSample(wide, 1, 30, 0, 20, 0, 0.5);
  ExpectSample(wide, 3, 30, 0, 45, 180, 0.25);
  EXPECT_EQ(wide.samples.origin[3], 3U);
  ReadOptions options;
  options.columns = "theta_i=names";
  const Measurement numbers = ReadText("theta_s;10;30\n-20;1;0,5\n45;2;\n", options);
  ASSERT_EQ(numbers.samples.size(), 3U);
  ExpectSample(numbers, 1, 30, 0, 20, 0, 0.5);
  EXPECT_EQ(numbers.set_aside[SetAsideReason::kHole], 1U);
  EXPECT_NE(MessageOf("theta_s,10,30\n-20,1,0.5\n45,2,3\n").find("--columns"), std::string::npos);
  // Polar rows by azimuth columns, of one incidence.
  ReadOptions incidence;
  incidence.keys = {"theta_i=30"};
  const Measurement pivot = ReadText("theta\\phi\t0\t120\t180\n20\t0.5\t1\t2\n45\t3\t4\t0.25\n", incidence);
  ASSERT_EQ(pivot.samples.size(), 6U);
  ExpectSample(pivot, 0, 30, 0, 20, 0, 0.5);
  ExpectSample(pivot, 1, 30, 0, 20, 120, 1);
  ExpectSample(pivot, 5, 30, 0, 45, 180, 0.25);
  EXPECT_NE(MessageOf("theta\\phi\t0\t120\t180\n20\t0.5\t1\t2\n45\t3\t4\t0.25\n").find("theta_i"), std::string::npos);
}

TEST(CsvLayouts, VectorsAndHalfAngles) {
  ExpectTheTwo(
      ReadText("wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f\n0.5,0,0.8660254037844386,0.3420201433256687,0,0.9396926207859084,0.5\n"
               "1,0,1.7320508075688772,-0.7071067811865475,0,0.7071067811865476,0.25\n"));
  // Rusinkiewicz: the half vector at the normal and a difference of 30 degrees is the mirror pair.
  const Measurement half = ReadText("theta_h,phi_h,theta_d,phi_d,R,G,B\n0,0,30,0,0.5,0.4,0.3\n25,40,0,0,1,1,1\n");
  ASSERT_EQ(half.samples.size(), 2U);
  ExpectSample(half, 0, 30, 0, 30, 180, 0.5);
  ExpectSample(half, 1, 25, 40, 25, 40, 1);
  EXPECT_EQ(half.channels.names, (std::vector<std::string>{"R", "G", "B"}));
  const Measurement relative = ReadText("theta_l,theta_v,phi_d,R,G,B\n30,45,180,0.5,0.4,0.3\n");
  ExpectSample(relative, 0, 30, 0, 45, 180, 0.5);
  EXPECT_TRUE(relative.isotropic);
}

TEST(CsvLayouts, NamesThatReadInTwoWaysAreAsked) {
  EXPECT_NE(MessageOf("theta_i [0.1 deg],theta_r [0.1 deg],BRDF\n100,200,1\n")
                .find("holds values at one angle, by its name, "
                      "but 'BRDF' holds values too"),
            std::string::npos);
  EXPECT_NE(MessageOf("theta_s,AOI=0.2 rad,AOI=30 deg\n10,1,2\n").find("have different units"), std::string::npos);
  EXPECT_NE(MessageOf("theta_i,theta_r,BRDF_raw,BRDF_corrected\n10,20,1,2\n").find("--value-column \"BRDF_raw\""),
            std::string::npos);
  EXPECT_NE(MessageOf("AOI: 30\nAzimuth: 90\ntheta_s,BSDF\n10,1\n").find("the head states 'Azimuth: 90', which"),
            std::string::npos);
  EXPECT_EQ(ReadText("AOI: 30\nAzimuth: 90\ntheta_s,phi_s,BSDF\n10,20,1\n").samples.size(), 1U);
}

TEST(CsvLayouts, UnitsOfChannels) {
  ReadOptions brdf;
  brdf.value_kind = ValueKind::kBrdf;
  const Measurement rgb = ReadText("theta_i,theta_o,R (%),G (%),B (%)\n10,20,50,40,30\n", brdf);
  EXPECT_DOUBLE_EQ(rgb.samples.values[2][0], 0.3);
  EXPECT_DOUBLE_EQ(ReadText("# value-kind: f\ntheta_i,theta_o,Y [%]\n10,20,50\n").samples.values[0][0], 0.5);
  EXPECT_NE(MessageOf("theta_i,theta_o,Y [%]\n10,20,50\n").find("'Y [%]' in percent can be f_r or pi f_r"),
            std::string::npos);
  const Measurement spectral = ReadText("theta_i;theta_o;450 nm;550nm\ndeg;deg;%;%\n10;20;50;40\n", brdf);
  EXPECT_DOUBLE_EQ(spectral.samples.values[1][0], 0.4);
  EXPECT_EQ(spectral.channels.wavelengths_nm, (std::vector<double>{450, 550}));
  EXPECT_NE(MessageOf("theta_i;theta_o;450 nm\ndeg;deg;furlong\n10;20;50\n").find("has the unit 'furlong'"),
            std::string::npos);
}

TEST(CsvLayouts, AnAngleOfADirectionByItsUnit) {
  ExpectTheTwo(ReadText("AOI (deg),observation (deg),BRDF\n30,-20,0.5\n30,45,0.25\n"));
  ExpectTheTwo(ReadText("theta_src,theta_rcv,brdfPerSr\n30,-20,0.5\n30,45,0.25\n"));
  EXPECT_NE(MessageOf("AOI,observation,BRDF\n30,-20,0.5\n").find("polar angle of the viewer"), std::string::npos);
}

TEST(CsvLayouts, ALonePhiIsTheRelativeAzimuth) {
  const Measurement m = ReadText("theta_i,theta_r,phi,brdf\n30,30,180,5\n30,30,0,0.1\n");
  ExpectSample(m, 0, 30, 0, 30, 180, 5);  // the mirror direction
  ExpectSample(m, 1, 30, 0, 30, 0, 0.1);  // the light's own
  EXPECT_TRUE(m.isotropic);
  EXPECT_NE(m.conventions.at("azimuths").find("relative to the light"), std::string::npos);
  // Beside the light's azimuth it is the viewer's.
  const Measurement viewer = ReadText("theta_i,phi_i,theta_r,phi,brdf\n30,10,40,130,5\n");
  ExpectSample(viewer, 0, 30, 10, 40, 130, 5);
}

TEST(CsvLayouts, ChannelsByTheirSiblings) {
  EXPECT_EQ(ReadText("theta_i,theta_o,brdf_r,brdf_g,brdf_b\n30,40,1,2,3\n").channels.names,
            (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(ReadText("theta_i,theta_o,f_R,f_G,f_B\n30,40,1,2,3\n").channels.names,
            (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(ReadText("theta_i,theta_o,red,green,blue\n30,40,1,2,3\n").samples.values[2][0], 3);
  EXPECT_EQ(ReadText("theta_i,theta_o,f_R\n30,40,1\n").channels.names, (std::vector<std::string>{"Y"}));
  EXPECT_NE(MessageOf("theta_i,theta_o,f_R,f_G\n30,40,1,2\n").find("of the channels RGB only 2"), std::string::npos);
}

TEST(CsvLayouts, ColumnsAreMappedByOptionAndByKey) {
  ReadOptions options;
  options.columns = "theta_i=alpha1,theta_o=#2,f=Messwert,dphi=180";
  const std::string rows = "alpha1;alpha2;Messwert\n30;45;0.25\n";
  const Measurement m = ReadText(rows, options);
  ExpectSample(m, 0, 30, 0, 45, 180, 0.25);
  ExpectSample(ReadText("# columns: theta_i=alpha1,theta_o=#2,f=Messwert,dphi=180\n" + rows), 0, 30, 0, 45, 180, 0.25);
  options.columns = "theta_i=alpha7,theta_o=#2,f=Messwert";
  EXPECT_NE(MessageOf(rows, options).find("no column is named 'alpha7'"), std::string::npos);
  options.columns = "alpha1";
  EXPECT_NE(MessageOf(rows, options).find("is not MEANING=COLUMN"), std::string::npos);
  options.columns = "colour=alpha1";
  EXPECT_NE(MessageOf(rows, options).find("no meaning of a column"), std::string::npos);
  // The unit may come with the meaning.
  options.columns = "theta_i=a,theta_o=b,phi_o (rad)=c";
  const Measurement radians = ReadText("a,b,c,f\n30,45,3.141592653589793,0.25\n", options);
  ExpectSample(radians, 0, 30, 0, 45, 180, 0.25);
}

TEST(CsvLayouts, AScanPerBlockOfOneFile) {
  const Measurement m = ReadText("# AOI: 10\ntheta_s,BSDF\n-20,1\n45,2\n# AOI: 30\ntheta_s,BSDF\n-20,0.5\n45,0.25\n");
  ASSERT_EQ(m.samples.size(), 4U);
  ExpectSample(m, 0, 10, 0, 20, 0, 1);
  ExpectSample(m, 3, 30, 0, 45, 180, 0.25);
  const Measurement wavelengths =
      ReadText("wavelength: 450 nm\ntheta_i,theta_o,f\n30,40,1\n30,50,2\nwavelength: 550 nm\n30,40,3\n30,50,4\n");
  EXPECT_EQ(wavelengths.channels.wavelengths_nm, (std::vector<double>{450, 550}));
  ASSERT_EQ(wavelengths.samples.size(), 2U);
  EXPECT_EQ(wavelengths.samples.values[1][1], 4);
}

TEST(CsvLayouts, ASampleThatIsTurned) {
  const Measurement column =
      ReadText("theta_i,phi_i,theta_o,phi_o,sample_rotation,f\n30,0,40,90,20,1\n30,0,40,90,50,2\n");
  ExpectSample(column, 0, 30, -20, 40, 70, 1);
  ExpectSample(column, 1, 30, -50, 40, 40, 2);
}

TEST(CsvLayouts, CosinesInPlaceOfAngles) {
  for (const char* names : {"cos_theta_i,cos_theta_o,dphi", "cos(theta_i),cos(theta_o),dphi (deg)", "mu0,mu,raa"}) {
    const Measurement m = ReadText(std::string(names) + ",brdf\n0.5,1,0,2\n1,0.5,90,3\n1.5,0.5,0,4\n");
    ASSERT_EQ(m.samples.size(), 2U) << names;
    ExpectSample(m, 0, 60, 0, 0, 0, 2);
    ExpectSample(m, 1, 0, 0, 60, 90, 3);
    EXPECT_EQ(m.set_aside[SetAsideReason::kNotFinite], 1U) << "a cosine of 1.5";
  }
  // Beside the angles they are not needed.
  const Measurement m = ReadText("theta_i,theta_o,dphi,cos_theta_i,brdf\n60,0,0,0.123,2\n");
  ExpectSample(m, 0, 60, 0, 0, 0, 2);
}

TEST(CsvLayouts, TwoDirectionCosinesOfTheViewerAreAsked) {
  EXPECT_NE(MessageOf("theta_i,alpha_s,beta_s,BRDF\n10,0.1,0.2,1\n").find("axes are not said"), std::string::npos);
}

TEST(CsvLayouts, PolarisationOfTheLightAndOfTheViewer) {
  constexpr char kFourRows[] = "10,20,0,s,s,1\n10,20,0,s,p,2\n10,20,0,p,s,4\n10,20,0,p,p,8\n";
  for (const char* names : {"source pol,detector pol", "incident polarization,analyzer"}) {
    const Measurement m = ReadText("theta_i,theta_o,dphi," + std::string(names) + ",brdf\n" + kFourRows);
    ASSERT_EQ(m.samples.size(), 1U) << names;
    EXPECT_EQ(m.samples.values[0][0], 7.5) << "half of the sum";
  }
  const Measurement joined =
      ReadText("theta_i,theta_o,dphi,pol,brdf\n10,20,0,ss,1\n10,20,0,sp,2\n10,20,0,ps,4\n10,20,0,pp,8\n");
  ASSERT_EQ(joined.samples.size(), 1U);
  EXPECT_EQ(joined.samples.values[0][0], 7.5);
  const Measurement turned = ReadText("theta_i,theta_o,dphi,polarizer angle (deg),brdf\n10,20,0,0,1\n10,20,0,90,2\n");
  EXPECT_EQ(turned.samples.values[0][0], 1.5);
  ReadOptions options;
  options.where = "source pol=s";
  EXPECT_NE(MessageOf("theta_i,theta_o,dphi,source pol,detector pol,brdf\n" + std::string(kFourRows), options)
                .find("choose one of 'detector pol' too"),
            std::string::npos);
  // Rows with a wavelength of their own may all say the same.
  EXPECT_EQ(ReadText("wavelength (nm),theta_i,theta_o,pol,brdf\n550,10,20,u,1\n650,10,20,u,2\n").channels.size(), 2U);
}

TEST(CsvLayouts, ValuesNamedByABareAngleAreAsked) {
  ReadOptions options;
  options.columns = "theta_i=names";
  for (const char* names : {"BRDF(10deg),BRDF(30deg)", "BRDF_10deg,BRDF_30deg", "f(10),f(30)", "10 deg,30 deg"}) {
    const std::string text = "theta_s," + std::string(names) + "\n0,1,2\n20,3,4\n";
    EXPECT_NE(MessageOf(text).find("by --columns, as in theta_i=names"), std::string::npos) << names;
    const Measurement m = ReadText(text, options);
    ASSERT_EQ(m.samples.size(), 4U) << names;
    ExpectSample(m, 1, 30, 0, 0, 0, 2);
  }
}

TEST(CsvLayouts, ReadingsOfADetectorAreAsked) {
  const std::string text = "theta_i,theta_o,dphi,counts\n10,20,180,500\n10,30,180,250\n";
  EXPECT_NE(MessageOf(text).find("choose them with --value-column \"counts\", and fit with --scale free"),
            std::string::npos);
  EXPECT_NE(MessageOf("theta_i,theta_o,Signal (V)\n10,20,5\n").find("--value-column \"Signal (V)\""),
            std::string::npos);
  ReadOptions options;
  options.value_column = "counts";
  EXPECT_TRUE(HasRemark(ReadText(text, options), "have no unit that is known"));
}

TEST(CsvLayouts, SamplesInOneFileAreToldApart) {
  const Measurement m = ReadText("sample,theta_i,theta_o,brdf\nA,10,20,1\nB,10,20,2\nA,10,30,1\nB,10,30,2\n");
  EXPECT_TRUE(HasRemark(m, "rows of the same directions differ in 'sample' (A, B)"));
}

TEST(CsvLayouts, PolarisationsInColumns) {
  for (const char* names :
       {"BRDF_s,BRDF_p", "f_s,f_p", "f_TE,f_TM", "BRDF_s (1/sr),BRDF_p (1/sr)", "s-BRDF,p-BRDF",
        "BRDF (s-pol),BRDF (p-pol)", "s-polarised BRDF,p-polarised BRDF", "BRDF perpendicular,BRDF parallel"}) {
    const Measurement m = ReadText("theta_i,theta_o,dphi," + std::string(names) + "\n10,20,0,1,2\n10,30,0,3,-\n");
    ASSERT_EQ(m.samples.size(), 1U) << names;
    EXPECT_EQ(m.samples.values[0][0], 1.5) << names;
    EXPECT_EQ(m.set_aside[SetAsideReason::kHole], 2U) << "one without a value, and its fellow";
    EXPECT_TRUE(HasRemark(m, "were averaged to f_r of unpolarised light; --value-column ")) << names;
  }
  const Measurement four = ReadText("theta_i,theta_o,dphi,f_ss,f_sp,f_ps,f_pp\n10,20,0,1,2,4,8\n");
  EXPECT_EQ(four.samples.values[0][0], 7.5) << "half of the sum";
  const Measurement mean = ReadText("theta_i,theta_o,dphi,BRDF_s,BRDF_p,BRDF_avg\n10,20,0,1,2,1.4\n");
  EXPECT_EQ(mean.samples.values[0][0], 1.4);
  EXPECT_TRUE(HasRemark(mean, "columns not used: BRDF_s, BRDF_p"));
  ReadOptions options;
  options.value_column = "BRDF_p";
  EXPECT_EQ(ReadText("theta_i,theta_o,dphi,BRDF_s,BRDF_p\n10,20,0,1,2\n", options).samples.values[0][0], 2);
  EXPECT_EQ(ReadText("theta_i,theta_o,dphi,f_s\n10,20,0,1\n").samples.size(), 1U);
  EXPECT_NE(MessageOf("theta_i,theta_o,dphi,pol,f_s,f_p\n10,20,0,x,1,2\n").find("stand in a column and in the names"),
            std::string::npos);
}

TEST(CsvLayouts, SignedAnglesInTheNamesOfATable) {
  for (const char* names : {"theta_i,theta_o=-40,theta_o=40,theta_o=-0", "theta_i,theta_o -40,theta_o 40,theta_o 0",
                            "theta_i,theta_o @ -40 deg,theta_o @ 40 deg,theta_o @ 0 deg",
                            "theta_i,theta_o=\xe2\x88\x92"
                            "40,theta_o=40,theta_o=0"}) {
    SCOPED_TRACE(names);
    const Measurement m = ReadText(std::string(names) + "\n10,1,2,3\n");
    ASSERT_EQ(m.samples.size(), 3U);
    ExpectSample(m, 0, 10, 0, 40, 0, 1);
    ExpectSample(m, 1, 10, 0, 40, 180, 2);
  }
}

TEST(CsvLayouts, AnAngleAboveOrInTheNamesOfATable) {
  for (const char* head : {"AOI (deg),,\ntheta_o,10,30\n", "theta_o,inc10,inc30\n"}) {
    const Measurement m = ReadText(std::string(head) + "0,1,2\n20,3,4\n");
    ASSERT_EQ(m.samples.size(), 4U) << head;
    ExpectSample(m, 1, 30, 0, 0, 0, 2);
    ExpectSample(m, 2, 10, 0, 20, 180, 3);
  }
}

// The name of what the columns are in a line of its own, as pandas and pivot tables of spreadsheets write it.
TEST(CsvLayouts, PivotTables) {
  for (const char* text :
       {"theta_i,10,30\ntheta_o,,\n20,1,3\n40,2,4\n", ",brdf,brdf\ntheta_i,10,30\ntheta_o,,\n20,1,3\n40,2,4\n",
        "BRDF;theta_i;\ntheta_o;10;30\n20;1;3\n40;2;4\n"}) {
    const Measurement m = ReadText(text);
    ASSERT_EQ(m.samples.size(), 4U) << text;
    ExpectSample(m, 0, 10, 0, 20, 180, 1);
    ExpectSample(m, 1, 30, 0, 20, 180, 3);
    ExpectSample(m, 3, 30, 0, 40, 180, 4);
  }
  EXPECT_NE(MessageOf(",10,30\ntheta_o,,\n20,1,3\n40,2,4\n").find("theta_i"), std::string::npos);
}

TEST(CsvLayouts, ATableOfAzimuthsForEachIncidence) {
  const std::string names = "theta_o\\phi_o,0,90\n";
  const Measurement m = ReadText("theta_i = 10\n" + names + "20,1,2\n40,3,4\n\ntheta_i = 30\n" + names + "20,5,6\n");
  ASSERT_EQ(m.samples.size(), 6U);
  ExpectSample(m, 1, 10, 0, 20, 90, 2);
  ExpectSample(m, 5, 30, 0, 20, 90, 6);
}

TEST(CsvLayouts, WhereAnAzimuthCountsFromInItsName) {
  const Measurement mirror = ReadText("theta_i,theta_o,relative azimuth (0 = specular),brdf\n30,20,0,1\n30,40,90,2\n");
  ASSERT_EQ(mirror.samples.size(), 2U);
  EXPECT_GT(Dot(mirror.samples.wo(0), Reflect(mirror.samples.wi(0), {0, 0, 1})), std::cos(DegreesToRadians(11)));
  const Measurement light = ReadText("theta_i,theta_o,relative azimuth (180 = specular),brdf\n30,20,0,1\n30,40,90,2\n");
  ASSERT_EQ(light.samples.size(), 2U);
  EXPECT_GT(Dot(light.samples.wo(0), light.samples.wi(0)), std::cos(DegreesToRadians(11)));
  EXPECT_NE(MessageOf("theta_i,theta_o,relative azimuth (nominal),brdf\n30,20,0,1\n").find("speaks of an angle"),
            std::string::npos);
}

TEST(CsvLayouts, ColumnsOfRepetitions) {
  const Measurement m = ReadText("theta_i,theta_o,BRDF 1,BRDF 2,BRDF mean,BRDF std\n30,40,1,3,2,0.5\n");
  EXPECT_EQ(m.samples.values[0][0], 2);
  EXPECT_EQ(m.samples.sigma.size(), 1U);
  const std::string message = MessageOf("theta_i,theta_o,BRDF_1,BRDF_2\n30,40,1,3\n");
  EXPECT_NE(message.find("--value-column \"BRDF_1\""), std::string::npos) << message;
  EXPECT_NE(message.find("several samples"), std::string::npos) << message;
  ReadOptions options;
  options.value_column = "BRDF_2";
  EXPECT_EQ(ReadText("theta_i,theta_o,BRDF_1,BRDF_2\n30,40,1,3\n", options).samples.values[0][0], 3);
}

TEST(CsvLayouts, ValuesNamedAmongOtherWords) {
  EXPECT_NEAR(ReadText("# Relative Azimuth, Viewing Zenith, Incident Zenith, Wavelength, Panel BRF\n"
                       "52,14,22,800,1.09\n129,50,53,800,1.05\n")
                  .samples.values[0][0],
              1.09 / kPi, 1e-12);
  ReadOptions options;
  options.value_column = "Panel BRF";
  EXPECT_NEAR(ReadText("theta_i,theta_o,Panel BRF,Tile BRF\n30,40,1,2\n", options).samples.values[0][0], 1 / kPi,
              1e-12);
  for (const char* name : {"BRDF (dBsr)", "BRDF model", "reference BRDF", "BRDF_raw", "BRDF fit"})
    EXPECT_NE(MessageOf(std::string("theta_i,theta_o,") + name + "\n30,40,1\n"), "(was read)") << name;
  EXPECT_NE(MessageOf("theta_i,theta_o,Sample A,Sample B\n30,40,1,2\n").find("--value-column \"Sample A\""),
            std::string::npos);
}

TEST(CsvLayouts, ReflectancesAtWavelengths) {
  for (const char* names :
       {"R450,R550", "refl_450,refl_550", "rho 450nm,rho 550nm", "reflectance_450nm,reflectance_550nm"}) {
    const std::string text = std::string("theta_i,theta_o,") + names + "\n30,40,1,2\n";
    EXPECT_NE(MessageOf(text).find("--value-kind pi-f or --value-kind f"), std::string::npos) << names;
    ReadOptions options;
    options.value_kind = ValueKind::kReflectanceFactor;
    const Measurement m = ReadText(text, options);
    ASSERT_EQ(m.channels.wavelengths_nm, (std::vector<double>{450, 550})) << names;
    EXPECT_NEAR(m.samples.values[1][0], 2 / kPi, 1e-12) << names;
    EXPECT_NEAR(ReadText("BRF Values\n" + text).samples.values[1][0], 2 / kPi, 1e-12) << names;
  }
  EXPECT_TRUE(HasRemark(ReadText("SZA,VZA,450,550\n30,40,1,2\n"), "are pi f_r: --value-kind pi-f"));
  EXPECT_FALSE(HasRemark(ReadText("theta_i,theta_o,450nm,550nm\n30,40,1,2\n"), "pi-f"));
}

// As automotive instruments write them: a row a wavelength, a column a geometry.
TEST(CsvLayouts, ColumnsOfAspecularAngles) {
  const std::string table = "Wavelength,r45as-15,r45as15,45as110\n550,40,60,2\n560,41,61,3\n";
  EXPECT_NE(MessageOf(table).find("--value-kind pi-f, and --value-scale %"), std::string::npos);
  for (const std::string& title : {std::string("Reflectance factor (%)\n"), std::string()}) {
    ReadOptions options;
    if (title.empty()) {
      options.value_kind = ValueKind::kReflectanceFactor;
      options.value_scale = "%";
    }
    const Measurement m = ReadText(title + table, options);
    ASSERT_EQ(m.samples.size(), 3U);
    ASSERT_EQ(m.channels.wavelengths_nm, (std::vector<double>{550, 560}));
    ExpectSample(m, 0, 45, 0, 60, 180, 0.4 / kPi);
    ExpectSample(m, 1, 45, 0, 30, 180, 0.6 / kPi);
    ExpectSample(m, 2, 45, 0, 65, 0, 0.02 / kPi);
  }
  EXPECT_NE(MessageOf("Reflectance factor (%)\ntheta_o,45as15,AOI=10\n10,1,2\n"), "(was read)");
}

TEST(CsvLayouts, GeometriesInOneWord) {
  EXPECT_NE(MessageOf("Geometry,550nm,560nm\n45as15,1,2\n45as25,2,3\n").find("AOI 45, aspecular 15"),
            std::string::npos);
  EXPECT_NE(MessageOf("Geometry,400nm,500nm\n45:0,1,2\n45:30,1,2\n").find("theta_i 45, theta_o 0"), std::string::npos);
  EXPECT_NE(MessageOf("Geometry,BRDF\n45/0,1\n45/30,2\n").find("theta_i 45, theta_o 0"), std::string::npos);
}

TEST(CsvLayouts, FixedAnglesInTheLineAbove) {
  const Measurement m = ReadText("AOI,10,10,30,30\nangle,BRDF,std,BRDF,std\n20,2,0.1,3,0.3\n40,4,0.4,5,0.5\n");
  ASSERT_EQ(m.samples.size(), 4U);
  ExpectSample(m, 1, 30, 0, 20, 180, 3);
  EXPECT_EQ(m.samples.sigma.size(), 4U);
  // Cells that were merged, decimal commas, another kind.
  const Measurement merged = ReadText("AOI;10;;30;\nangle;BRF;std;BRF;std\n20;2,5;0,1;3;0,3\n");
  ExpectSample(merged, 0, 10, 0, 20, 180, 2.5 / kPi);
  ExpectSample(ReadText("theta_o,i=10,i=30\n20,2,3\n"), 1, 30, 0, 20, 180, 3);
}

// gnuplot's blocks, whose comments state the angle without a colon.
TEST(CsvLayouts, AnglesInCommentsAmidRows) {
  const Measurement m =
      ReadText("# theta_o brdf\n# theta_i 10\n20 2\n30 3\n\n\n# theta_i 30\n20 4\n30 5\n# done in 30 minutes\n");
  ASSERT_EQ(m.samples.size(), 4U);
  ExpectSample(m, 2, 30, 0, 20, 180, 4);
}

TEST(CsvLayouts, PartsOfOtherSamples) {
  const std::string names = "theta_i,theta_o,brdf\n";
  const Measurement m =
      ReadText("Sample A\n" + names + "30,40,1\n30,50,1\n\nSample B\n" + names + "30,40,1.2\n30,50,1.2\n");
  EXPECT_TRUE(HasRemark(m, "below 'Sample B' in line 6"));
}

}  // namespace
}  // namespace lobefit
