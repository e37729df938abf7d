// Where the sun stands. Equations: NOAA Global Monitoring Laboratory, "General Solar Position Calculations" (PDF beside
// the NOAA Solar Calculator, gml.noaa.gov/grad/solcalc), a Fourier series after Spencer, "Fourier series representation
// of the position of the sun", Search 2 (1971). Good to about a quarter of a degree.

export interface SunPosition {
  /** Radians above the horizon, without refraction. */
  altitude: number;
  /** Radians from north over east. */
  azimuth: number;
}

const RADIANS = Math.PI / 180;

/** The zone that the page reckons in: whole hours from UTC by longitude. Daylight saving time is left out. */
export function zone_of(longitude: number): number {
  return Math.round(longitude / 15);
}

/** day: 1 to 365; minutes: since midnight in the zone of `zone_of`. */
export function sun_position(day: number, minutes: number, longitude: number, latitude: number): SunPosition {
  const year = ((2 * Math.PI) / 365) * (day - 1 + (minutes / 60 - 12) / 24);
  const equation_of_time =
    229.18 *
    (0.000075 +
      0.001868 * Math.cos(year) -
      0.032077 * Math.sin(year) -
      0.014615 * Math.cos(2 * year) -
      0.040849 * Math.sin(2 * year));
  const declination =
    0.006918 -
    0.399912 * Math.cos(year) +
    0.070257 * Math.sin(year) -
    0.006758 * Math.cos(2 * year) +
    0.000907 * Math.sin(2 * year) -
    0.002697 * Math.cos(3 * year) +
    0.00148 * Math.sin(3 * year);
  const true_solar_time = minutes + equation_of_time + 4 * longitude - 60 * zone_of(longitude);
  const hour_angle = (true_solar_time / 4 - 180) * RADIANS;
  const phi = latitude * RADIANS;
  const altitude = Math.asin(
    Math.sin(phi) * Math.sin(declination) + Math.cos(phi) * Math.cos(declination) * Math.cos(hour_angle),
  );
  const south = Math.sin(phi) * Math.cos(declination) * Math.cos(hour_angle) - Math.cos(phi) * Math.sin(declination);
  const west = Math.cos(declination) * Math.sin(hour_angle);
  return { altitude, azimuth: (Math.atan2(west, south) + 3 * Math.PI) % (2 * Math.PI) };
}

/** "9 June" of a day of the year. */
export function day_text(day: number): string {
  return new Date(Date.UTC(2023, 0, day)).toLocaleDateString('en-GB', {
    day: 'numeric',
    month: 'long',
    timeZone: 'UTC',
  });
}

export function time_text(minutes: number): string {
  return `${String(Math.floor(minutes / 60)).padStart(2, '0')}:${String(minutes % 60).padStart(2, '0')}`;
}
