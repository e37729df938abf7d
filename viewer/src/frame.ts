// The local frame of the page: x east, y up, z south, metres, with its origin at the build's centre on the ground.
import { Matrix4, Vector3 } from 'three';
import { WGS84_ELLIPSOID } from '3d-tiles-renderer/three';

const RADIANS = Math.PI / 180;
export const EARTH_RADIUS = 6371000;

export interface Place {
  lon: number;
  lat: number;
  height: number;
}

export class Frame {
  /** From Earth-centred coordinates to the page's. */
  readonly from_earth: Matrix4;

  constructor(readonly centre: Place) {
    const { lat, lon, height } = centre;
    const east = new Vector3(),
      north = new Vector3(),
      up = new Vector3(),
      origin = new Vector3();
    WGS84_ELLIPSOID.getEastNorthUpAxes(lat * RADIANS, lon * RADIANS, east, north, up);
    WGS84_ELLIPSOID.getCartographicToPosition(lat * RADIANS, lon * RADIANS, height, origin);
    this.from_earth = new Matrix4().makeBasis(east, up, north.negate()).setPosition(origin).invert();
  }

  /** Longitude and latitude in degrees, height above the centre's ground in m, to the page's frame. */
  point(lon: number, lat: number, above_ground: number): Vector3 {
    const at = new Vector3();
    WGS84_ELLIPSOID.getCartographicToPosition(lat * RADIANS, lon * RADIANS, this.centre.height + above_ground, at);
    return at.applyMatrix4(this.from_earth);
  }

  /** Height of the ground in this frame at a place: the Earth falls away from the tangent plane. */
  static ground_at(x: number, z: number): number {
    return -(x * x + z * z) / (2 * EARTH_RADIUS);
  }
}
