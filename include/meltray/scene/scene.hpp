// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "meltray/core/constants.hpp"
#include "meltray/core/vec.hpp"
#include "meltray/laser/beam.hpp"
#include "meltray/laser/laser.hpp"
#include "meltray/materials/material.hpp"
#include "meltray/sph/kernel.hpp"
#include "meltray/terms/pressure/projection.hpp"
#include "meltray/terms/pressure/weakly_compressible.hpp"
#include "meltray/terms/surface_forces.hpp"
#include "meltray/time/integrator.hpp"

/// A scene is what a case file says, checked and with every default filled in; nothing is computed yet.
namespace meltray::scene {

// Choices that a term or a room below declares keep their names there.
using sph::KernelType;
using terms::GradientForm, terms::PressureSolver, terms::RecoilOnset, terms::SurfaceEntry, terms::Tension;

enum class Arrangement { lattice, jittered, rotated };
enum class FaceKind { free, wall, periodic };
enum class ThermalKind { adiabatic, temperature, flux };
enum class FlowSolver { isph, wcsph };
enum class SolidModel { fixed, elastic };
enum class DensityDiffusion { none, molteni_colagrossi, antuono };
enum class Projection { step, stage };
enum class PartitionChoice { automatic, explicit_, implicit_ };
enum class Optics { by_phase, solid, hot_melt };
enum class VelocityField { none, taylor_green, rotation };
enum class ShapeKind { box, ball };

/// One face of the box. A face where a workpiece was cropped is a wall: never a free surface.
struct Face {
  FaceKind kind = FaceKind::free;
  bool slip = false;             ///< wall: false = no slip
  Vec3 velocity = Vec3::Zero();  ///< of a moving wall [m/s]
  ThermalKind thermal = ThermalKind::adiabatic;
  double temperature = 0;  ///< [K], thermal = temperature
  double flux = 0;         ///< into the material [W/m^2], thermal = flux
};

/// A body of material that fills part of the box at t = 0. Later bodies replace earlier ones where they
/// overlap.
struct Body {
  ShapeKind shape = ShapeKind::box;
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();  ///< box [m]
  Vec3 center = Vec3::Zero(),
       radii = Vec3::Zero();     ///< ball: semi-axes, so that an ellipsoid is a ball too [m]
  double temperature = 300;      ///< initial [K]
  Vec3 velocity = Vec3::Zero();  ///< initial [m/s]
  bool clamped = false;          ///< elastic solid that stays at its place
};

/// [domain]: box, particles, gravity.
struct Domain {
  int dimension = 3;  ///< 2: the x-z plane; vectors of the scene are then (x, z, 0)
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  double spacing = 0;            ///< [m]
  double smoothing_ratio = 1.3;  ///< h / spacing
  KernelType kernel = KernelType::wendland_c2;
  Arrangement arrangement = Arrangement::lattice;
  double jitter = 0;  ///< displacement of the lattice points, fraction of the spacing
  int seed = 1;       ///< of the jitter
  double gravity = constants::standard_gravity;  ///< downwards [m/s^2]
  std::array<Face, 6> faces;                     ///< x_min, x_max, y_min, y_max, z_min, z_max
  std::vector<Body> bodies;
  VelocityField velocity_field = VelocityField::none;
  double velocity_scale = 0;  ///< amplitude of velocity_field [m/s]
};

/// [terms]: which effects exist in the scene.
struct Terms {
  bool conduction = false, viscosity = false, interface_viscosity = false, pressure = false;
  bool artificial_viscosity = false;
  bool surface_tension = false, marangoni = false, wetting = false, recoil = false;
  bool evaporation = false, radiation = false, buoyancy = false, gravity = false, melting = false;
};

/// [flow]: pressure, shifting, viscosities.
struct Flow {
  FlowSolver solver = FlowSolver::isph;
  SolidModel solid = SolidModel::fixed;
  double sound_speed = 0;          ///< numerical, of the equation of state [m/s]
  bool thermal_expansion = false;  ///< reference density follows the temperature
  GradientForm pressure_gradient = GradientForm::difference;
  Tension tension = Tension::full;
  DensityDiffusion density_diffusion = DensityDiffusion::antuono;
  double diffusion_coefficient = 0.1;      ///< delta of the density diffusion
  double artificial_viscosity = 1;         ///< alpha of Monaghan's viscosity
  double elastic_modulus_scale = 1;        ///< of Young's modulus of elastic solid
  double elastic_viscosity = 1;            ///< alpha of the artificial viscosity of elastic solid
  double elastic_artificial_stress = 0.3;  ///< epsilon of Gray's artificial stress
  double elastic_depth = 0;                ///< from the melt, within which solid moves [m]
  Projection projection = Projection::step;
  double pressure_tolerance = 1e-3;  ///< relative residual of the Poisson solve
  PressureSolver pressure_solver = PressureSolver::conjugate_gradients;
  int pressure_max_iterations = 500;
  bool free_surface = true;     ///< false: the fluid fills a closed or periodic box
  double drift_time = 0;        ///< in which errors of density are taken back [s]; 0: from the scene's speeds
  double least_distance = 0.8;  ///< in spacings, below which melt at the surface is parted; 0 = off
  double shifting = 0;          ///< coefficient C of the shifting velocity; 0 = off
  double shifting_speed = 0;    ///< least speed that shifting reckons with [m/s]
  double reference_speed = 0;   ///< [m/s] of interface viscosity (sound speed of the WCSPH twin)
  double interface_viscosity_free = 1;   ///< alpha_LG at the free surface
  double interface_viscosity_solid = 1;  ///< alpha_SL at the solid-liquid interface
  double interface_viscosity_ramp = 50;  ///< [K] above the melting point over which alpha_SL acts
};

/// Temperature at which a surface evaporates, radiates and feels recoil: that of its outermost particles,
/// whose centres stand half a spacing below the face, or that of the face itself.
enum class SurfaceTemperature { particle, face };

/// [surface]: free surface, surface tension, recoil, evaporation.
struct Surface {
  SurfaceTemperature temperature = SurfaceTemperature::particle;
  SurfaceEntry entry = SurfaceEntry::csf;
  RecoilOnset recoil_onset = RecoilOnset::smooth;
  double recoil_coefficient = 0.54;       ///< of the saturation pressure
  double evaporation_coefficient = 0.82;  ///< 1 - beta_r
  double recoil_pressure = 0;             ///< > 0: prescribed recoil [Pa] instead of p_sat (validation)
  double recoil_ramp = 0;                 ///< linear start of the prescribed recoil [s]
  double recoil_radius = 0;               ///< > 0: 1/e^2 radius of the prescribed recoil about x = y = 0 [m]
  double activation_ramp = 20;            ///< [K] above the melting point over which surface tension sets in
  double ambient_temperature = 300;       ///< [K] for radiation
};

/// [heat]: conduction away from the melt.
struct Heat {
  double initial_temperature = 300;  ///< [K]
  double bulk_interval =
      0;  ///< > 0: pairs of solid particles away from the melt exchange heat at this interval [s]
};

/// [laser]: absent in scenes without one.
struct Laser {
  laser::BeamSpec beam;
  laser::TraceOptions trace;
  Optics optics = Optics::by_phase;  ///< which refractive index the metal has
  double retrace_interval = 5e-6;    ///< [s]
  double retrace_motion = 0.5;  ///< retrace when a surface particle moved by this fraction of the spacing
};

/// [time] and [splitting].
struct Time {
  double end = 0;  ///< [s]
  IntegratorOptions integrator;
  double rtol = 1e-3;
  double atol_position = 0.05;  ///< fraction of the spacing
  double atol_velocity = 0.1;   ///< [m/s]
  double atol_density = 5e-3;   ///< fraction of the density
  double atol_temperature = 5;  ///< [K], turned into enthalpy with the solid's heat capacity
  double cfl_acoustic = 0.25;
  double cfl_advective = 0.2, cfl_capillary = 0.25, cfl_force = 0.25;
  double cfl_viscous = 0.8,
         cfl_thermal = 0.8;     ///< shares of the Gershgorin stability bound of explicit terms
  double beam_travel = 0.25;    ///< of the focal radius per step
  double laser_heating = 1000;  ///< by the light that a particle absorbs, per step [K]; as atol_temperature
  PartitionChoice conduction = PartitionChoice::automatic, viscosity = PartitionChoice::automatic,
                  interface_viscosity = PartitionChoice::automatic, evaporation = PartitionChoice::automatic;
  double linear_tolerance = 1e-6;  ///< of the implicit solves, relative
};

/// [output]
struct Output {
  double interval = 0;             ///< of history.csv [s]
  double snapshot_interval = 0;    ///< of particles/*.h5 [s]; 0 = start and end only
  double checkpoint_interval = 0;  ///< [s]; 0 = end only
};

struct Scene {
  std::string title;
  std::string model = "isph";  ///< row of Table 1
  Domain domain;
  Material material;
  Terms terms;
  Flow flow;
  Surface surface;
  Heat heat;
  std::optional<Laser> laser;
  Time time;
  Output output;

  /// Some term changes enthalpies.
  bool exchanges_heat() const {
    return terms.conduction || terms.evaporation || terms.radiation || laser.has_value();
  }
  /// Gravity acts as a force. Melt that fills its box between floor and lid cannot fall: its pressure is
  /// reckoned without the hydrostatic one, whose gradient over disordered particles would differ from the
  /// weight by more than buoyancy is.
  bool weighs() const {
    return terms.gravity && (flow.free_surface || domain.faces[4].kind == FaceKind::periodic);
  }
};

}  // namespace meltray::scene
