/** Rooms and things that people put on maps. */
import { request } from './api';
import type { PlaceChanged, PlacePost } from './types';

const at = (robot: string, what: string) => `map/${encodeURIComponent(robot)}/${what}`;

/** Put a room or thing on a map, change it, take it off; or only hear what would come of it. */
export const changePlace = (robot: string, post: PlacePost) => request<PlaceChanged>('POST', at(robot, 'places'), post);
/** Take over a whole object map. */
export const loadPlaces = (robot: string, whole: unknown) => request<PlaceChanged>('PUT', at(robot, 'file'), whole);
/** Where the object map is as a file. */
export const placesFile = (robot: string) => `/api/${at(robot, 'file')}`;
