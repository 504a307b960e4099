// How much light a flat boundary reflects.
#pragma once

#include "materials/metals.h"
#include "materials/rgb.h"

namespace marrow {

/// Unpolarised reflectance of a dielectric of relative index `eta` seen from outside; 1 beyond the critical angle of
/// eta < 1. `cos_theta` in [0, 1] is that of incidence.   [Fresnel 1823]
double fresnel_dielectric(double cos_theta, double eta);

/// Unpolarised reflectance of a metal, each channel.   [Born & Wolf, Principles of Optics, 14.2]
Rgb fresnel_conductor(double cos_theta, const ComplexIndex&);

/// Reflectance for diffuse light from outside, eta >= 1: 2 times the integral of F(mu) mu.
double diffuse_fresnel_outside(double eta);
/// Reflectance for diffuse light from inside: 1 - (1 - outside) / eta^2.   [Duntley 1942]
double diffuse_fresnel_inside(double eta);
/// Reflectance of a metal for diffuse light.
Rgb diffuse_fresnel(const ComplexIndex&);

}  // namespace marrow
